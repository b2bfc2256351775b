#include "apps/lab/plan/answer.h"

#include "apps/lab/json_number.h"
#include "apps/lab/trial.h"
#include "sim/error.h"
#include "sim/scene_build.h"

#include <fmt/format.h>

#include <chrono>

namespace laterna {

namespace {

using Json = nlohmann::json;

Json device_json(const Device& device) {
  const Intrinsics& k = device.intrinsics;
  return {{"size", {k.size.x, k.size.y}},
          {"intrinsics", {k.fx, k.fy, k.cx, k.cy}},
          {"lens", device.lens.model},
          {"parameters", device.lens.parameters},
          {"device_from_world", rows_of(device.device_from_world)}};
}

Device device_from(const Json& json) {
  Device device;
  const auto& k = json.at("intrinsics");
  device.intrinsics = {{json.at("size").at(0), json.at("size").at(1)}, k.at(0), k.at(1), k.at(2), k.at(3)};
  device.lens = {json.at("lens"), json.at("parameters")};
  const auto rows = json.at("device_from_world").get<std::array<std::array<double, 4>, 3>>();
  for (int i = 0; i < 3; ++i) {  // as they are: rigid_from_rows() would not keep their last bits
    for (int j = 0; j < 3; ++j)
      device.device_from_world.rotation[j][i] = rows[std::size_t(i)][std::size_t(j)];
    device.device_from_world.translation[i] = rows[std::size_t(i)][3];
  }
  return device;
}

const char* const status_names[] = {"ok", "weak", "refused"};

Status status_from(const std::string& name) {
  return name == "ok" ? Status::ok : name == "weak" ? Status::weak : Status::refused;
}

}  // namespace

RoundTrip round_trip(const SceneSpec& spec, const std::filesystem::path& folder, std::uint64_t seed) {
  RoundTrip trip;
  try {
    const Scene scene = build_scene(spec, folder);
    const auto start = std::chrono::steady_clock::now();
    StageTimes times;
    const Traced traced = trace(scene, times);
    TrialOptions options;
    options.seed = seed;
    for (ProjectorOutcome& outcome : run_trial(scene, traced, options, times))
      trip.answers.push_back(
          {outcome.solve.status, std::move(outcome.solve.reason), std::move(outcome.solve.estimate)});
    trip.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  } catch (const InputError& error) {
    trip.answers.assign(spec.projectors.size(), {Status::refused, error.what(), {}});
  }
  return trip;
}

Json round_trip_json(const RoundTrip& trip) {
  Json answers = Json::array();
  for (const Answer& a : trip.answers) {
    answers.push_back({{"status", status_names[int(a.status)]}, {"reason", a.reason}});
    if (a.status != Status::refused) answers.back()["estimate"] = device_json(a.estimate);
  }
  return {{"answers", answers}, {"seconds", finite_or_null(trip.seconds)}};
}

RoundTrip round_trip_from(const Json& json) {
  RoundTrip trip;
  trip.seconds = number_or_nan(json, "seconds");
  for (const Json& a : json.at("answers"))
    trip.answers.push_back({status_from(a.at("status")), a.at("reason"),
                            a.contains("estimate") ? device_from(a["estimate"]) : Device{}});
  return trip;
}

std::vector<std::vector<glm::dvec3>> volumes_of(const SceneSpec& spec, const std::filesystem::path& folder) {
  Scene scene = build_scene(spec, folder);
  for (Camera& camera : scene.cameras) {  // exposures do not matter here, and cost rays
    camera.sensor.exposure_time_s.reset();
    camera.sensor.saturation_cd_per_m2 = 1;
  }
  StageTimes times;
  const Traced traced = trace(scene, times);
  std::vector<std::vector<glm::dvec3>> volumes;
  for (std::size_t p = 0; p < scene.projectors.size(); ++p) {
    const Device& truth = scene.projectors[p].device;
    std::vector<double> depths = depths_of(truth, lit_points(traced, int(p)));
    if (depths.empty()) throw Refusal(fmt::format("\"{}\" lights nothing that a camera sees", truth.name));
    volumes.push_back(image_grid(truth, volume_depths(std::move(depths))));
  }
  return volumes;
}

}  // namespace laterna
