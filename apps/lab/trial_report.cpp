#include "apps/lab/trial_report.h"

#include "apps/lab/json_number.h"
#include "apps/lab/matrices.h"
#include "sim/believed.h"
#include "sim/error.h"
#include "sim/plain_name.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

namespace laterna {

using Json = nlohmann::json;

namespace {

Json seconds_json(const StageTimes& times) {
  Json json = Json::object();
  for (const auto& stage : times.stages) json[stage.name] = stage.seconds;
  json["total"] = times.total();
  return json;
}

Json sigma_json(const SolveResult& solve) {
  Json json = Json::object();
  for (std::size_t i = 0; i < solve.sigma.size(); ++i)
    json[solve.parameter_names[i]] = finite_or_null(solve.sigma[i]);
  return json;
}

// The value of each tangent parameter at the estimate: rotation as a Rodrigues vector.
std::vector<double> values_of(const Device& d) {
  std::vector<double> values{d.intrinsics.fx, d.intrinsics.fy, d.intrinsics.cx, d.intrinsics.cy};
  values.insert(values.end(), d.lens.parameters.begin(), d.lens.parameters.end());
  const glm::dvec3 w = rotation_vector_rad(d.device_from_world.rotation), t = d.device_from_world.translation;
  values.insert(values.end(), {w.x, w.y, w.z, t.x, t.y, t.z});
  return values;
}

// How the prediction is made up, where cameras are uncertain.
Json camera_share_json(const SolveResult& solve) {
  return {{"from_noise",
           finite_or_null(std::sqrt(std::max(0.0, std::pow(solve.predicted_volume_rms_px, 2) -
                                                      std::pow(solve.predicted_volume_rms_camera_px, 2))))},
          {"from_camera", finite_or_null(solve.predicted_volume_rms_camera_px)}};
}

std::string error_line(const char* name, const ErrorSummary& e) {
  return fmt::format("  {:<14} {:>10.4g} {:>10.4g} {:>14.4g} {:>9}{}\n", name, e.rms, e.max, e.predicted_rms,
                     e.points, e.failed ? fmt::format("  ({} cannot be projected)", e.failed) : "");
}

std::string matrix_lines(const Device& estimate, const Device* truth) {
  const glm::dmat4 a = texture_from_world(estimate);
  const glm::dmat4 b = truth ? texture_from_world(*truth) : a;
  std::string text =
      truth ? "  T recovered                                                 T true\n" : "  T recovered\n";
  for (const int i : {0, 1, 3}) {  // the r row is no part of any error
    text += fmt::format("  {} {:>13.7f} {:>13.7f} {:>13.7f} {:>13.7f}", "str q"[i == 3 ? 4 : i], a[0][i],
                        a[1][i], a[2][i], a[3][i]);
    if (truth)
      text += fmt::format("   {:>13.7f} {:>13.7f} {:>13.7f} {:>13.7f}", b[0][i], b[1][i], b[2][i], b[3][i]);
    text += "\n";
  }
  return text;
}

Json device_json(const Device& d) {
  const Intrinsics& k = d.intrinsics;
  return {{"name", d.name},
          {"size", {k.size.x, k.size.y}},
          {"fx", k.fx},
          {"fy", k.fy},
          {"cx", k.cx},
          {"cy", k.cy},
          {"lens", {{"model", d.lens.model}, {"parameters", d.lens.parameters}}},
          {"device_from_world", rows_of(d.device_from_world)}};
}

Device device_of(const Json& json) {
  Device device;
  const auto size = json.at("size").get<std::array<int, 2>>();
  device.name = json.at("name");
  device.intrinsics = {{size[0], size[1]}, json.at("fx"), json.at("fy"), json.at("cx"), json.at("cy")};
  device.lens = {json.at("lens").at("model"), json.at("lens").at("parameters").get<std::vector<double>>()};
  device.device_from_world = rigid_from_rows(
      json.at("device_from_world").get<std::array<std::array<double, 4>, 3>>(), "device_from_world");
  validate(device);
  return device;
}

}  // namespace

std::string status_word(Status status) {
  return status == Status::ok ? "ok" : status == Status::weak ? "weak" : "refused";
}

Json error_json(const ErrorSummary& e) {
  return {{"rms", finite_or_null(e.rms)},
          {"max", finite_or_null(e.max)},
          {"points", e.points},
          {"predicted_rms", finite_or_null(e.predicted_rms)}};
}

Json estimate_json(const std::string& name, const SolveResult& solve) {
  const Device& d = solve.estimate;
  if (solve.status == Status::refused) {
    return {{"name", name}, {"status", status_word(solve.status)}, {"reason", solve.reason}};
  }
  Json json = device_json(d);
  json.update({{"name", name},
               {"status", status_word(solve.status)},
               {"reason", solve.reason},
               {"projector_from_world", json_of(projector_from_world(d.device_from_world))},
               {"texture_from_world", json_of(texture_from_world(d))},
               {"free_parameters", solve.free_parameters},
               {"sigma", sigma_json(solve)},
               {"parameters", solve.parameter_names},
               {"covariance", solve.covariance},
               {"predicted_volume_rms_px", finite_or_null(solve.predicted_volume_rms_px)},
               {"predicted_volume_px", camera_share_json(solve)}});
  return json;
}

std::string estimates_text(const std::vector<Json>& estimates, const Scene& believed) {
  Json cameras = Json::array();
  for (const Camera& camera : believed.cameras)
    cameras.push_back(device_json(believed.believe_truth ? camera.device : believed_device(camera)));
  return Json{{"format", "laterna-estimate"},
              {"version", 1},
              {"projectors", estimates},
              {"given_cameras", cameras}}
             .dump(2) +
         "\n";
}

std::vector<StoredEstimate> read_estimates(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw InputError(
        fmt::format("{}: no such file, expected an estimate by `laterna calibrate`", file.string()));
  try {
    const Json json = Json::parse(stream);
    if (json.at("format") != "laterna-estimate" || json.at("version") != 1) {
      throw InputError(fmt::format("{}: found format {}, expected \"laterna-estimate\" version 1",
                                   file.string(), json.at("format").dump()));
    }
    std::vector<StoredEstimate> stored;
    for (const Json& entry : json.at("projectors")) {
      if (entry.at("status") == "refused") continue;
      stored.push_back({device_of(entry), entry.value("covariance", std::vector<double>{})});
    }
    return stored;
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: not an estimate by `laterna calibrate`: {}", file.string(),
                                 plain_json_message(error.what())));
  }
}

Json trial_json(const Scene&, const std::vector<ProjectorOutcome>& outcomes, const StageTimes& times) {
  Json json{{"projectors", Json::array()}, {"seconds", seconds_json(times)}};
  for (const ProjectorOutcome& o : outcomes) {
    const bool refused = o.solve.status == Status::refused;
    Json entry{{"name", o.name},
               {"status", status_word(o.solve.status)},
               {"reason", o.solve.reason},
               {"correspondences", o.correspondences},
               {"flags", o.flags},
               {"surface_error_px", refused ? Json(nullptr) : error_json(o.verification.surface)},
               {"volume_error_px", refused ? Json(nullptr) : error_json(o.verification.volume)},
               {"extrapolation_error_px", refused ? Json(nullptr) : error_json(o.verification.extrapolation)},
               {"estimate", refused ? Json(nullptr) : estimate_json(o.name, o.solve)},
               {"seconds", seconds_json(o.times)}};
    if (!refused) {
      entry["fit_rms_px"] = finite_or_null(o.solve.fit_rms_px);
      entry["predicted_volume_rms_independent_px"] =
          finite_or_null(o.solve.predicted_volume_rms_independent_px);
      entry["predicted_volume_rms_px"] = finite_or_null(o.solve.predicted_volume_rms_px);
      entry["clusters"] = o.solve.clusters;
      entry["relief_over_throw"] = finite_or_null(o.solve.relief_over_throw);
      entry["iterations"] = o.solve.iterations;
      entry["termination"] = o.solve.termination;
    }
    json["projectors"].push_back(std::move(entry));
  }
  return json;
}

std::string verification_text(const Verification& v) {
  std::string text = "  error, projector px    rms        max   noise predicts    points\n";
  text += error_line("surface", v.surface) + error_line("volume", v.volume) +
          error_line("extrapolation", v.extrapolation);
  return text;
}

std::string solve_text(const SolveResult& solve, const Device* truth) {
  const std::vector<double> estimate = values_of(solve.estimate);
  const std::vector<double> true_values = truth ? values_of(*truth) : std::vector<double>{};
  std::string text =
      fmt::format("  fit {:.4g} px rms, {} iterations, {} clusters; relief is {:.2g} of the throw\n",
                  solve.fit_rms_px, solve.iterations, solve.clusters, solve.relief_over_throw);
  text += fmt::format("  {:<16} {:>16} {:>12}{}\n", "parameter", "recovered", "sigma",
                      truth ? "             true" : "");
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    text += fmt::format("  {:<16} {:>16.8g} {:>12.3g}", solve.parameter_names[i], estimate[i],
                        i < solve.sigma.size() ? solve.sigma[i] : NAN);
    if (truth && true_values.size() == estimate.size()) text += fmt::format(" {:>16.8g}", true_values[i]);
    text += "\n";
  }
  if (!solve.covariance_camera.empty()) {
    text += fmt::format(
        "  predicted error over the volume {:.4g} px, of it {:.4g} px from the cameras' uncertainty\n",
        solve.predicted_volume_rms_px, solve.predicted_volume_rms_camera_px);
  }
  return text + matrix_lines(solve.estimate, truth);
}

std::string trial_text(const Scene& scene, const std::vector<ProjectorOutcome>& outcomes) {
  std::string text;
  for (const ProjectorOutcome& o : outcomes) {
    text += fmt::format("projector \"{}\": {} correspondences\n", o.name, o.correspondences);
    for (const std::string& flag : o.flags) text += fmt::format("  pictures: {}\n", flag);
    if (o.solve.status != Status::refused) {
      text += solve_text(o.solve, &scene.projectors[o.projector].device);
      text += verification_text(o.verification);
    }
    text += fmt::format("  verdict: {}{}{}\n", status_word(o.solve.status),
                        o.solve.reason.empty() ? "" : ": ", o.solve.reason);
  }
  return text;
}

}  // namespace laterna
