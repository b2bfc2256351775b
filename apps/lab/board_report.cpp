#include "apps/lab/board_report.h"

#include "apps/lab/trial_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace laterna {

using Json = nlohmann::json;

namespace {

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

bool has_estimate(const BoardCalibration& c) { return c.status != Status::refused; }

// The sigmas of one device under their own names: "camera fx" is "fx" of the camera.
Json sigma_json(const BoardCalibration& c, const std::string& device) {
  Json json = Json::object();
  for (std::size_t i = 0; i < c.parameter_names.size(); ++i) {
    if (c.parameter_names[i].starts_with(device + " "))
      json[c.parameter_names[i].substr(device.size() + 1)] = number(c.sigma[i]);
  }
  return json;
}

Json device_json(const BoardCalibration& c, std::size_t d) {
  const Device& device = c.devices[d];
  const Intrinsics& k = device.intrinsics;
  Json json = {{"name", device.name},
               {"size", {k.size.x, k.size.y}},
               {"fx", k.fx},
               {"fy", k.fy},
               {"cx", k.cx},
               {"cy", k.cy},
               {"lens", {{"model", device.lens.model}, {"parameters", device.lens.parameters}}},
               {"sigma", sigma_json(c, device.name)},
               {"known", c.ladder.fit.capture.devices[d].known.has_value()},
               {"sigma_px", c.ladder.fit.sigma_px[d]},
               {"fit_rms_px", c.ladder.fit.rms_px[d]},
               {"coverage", c.diagnosis.devices[d].coverage},
               {"prediction_sigma_px", Json::array()}};
  for (const RangeSigma& r : c.diagnosis.devices[d].ranges)
    json["prediction_sigma_px"].push_back({{"range", number(r.range)},
                                           {"center", number(r.center_px)},
                                           {"rms", number(r.rms_px)},
                                           {"worst", number(r.worst_px)}});
  if (d > 0) json["device_from_camera"] = rows_of(device.device_from_world);
  return json;
}

Json rung_json(const Rung& rung) {
  Json folds = Json::array(), lenses = Json::array();
  for (const HeldOutPose& fold : rung.held_out.folds) folds.push_back(number(fold.rms_px));
  for (const auto& terms : rung.terms) lenses.push_back(terms_text(terms));
  return {{"lenses", lenses},
          {"board_bend", rung.bend},
          {"added", rung.added},
          {"chosen", rung.chosen},
          {"solved", rung.solved},
          {"fit_rms_px", rung.fit_rms_px},
          {"held_out_px",
           {{"rms", number(rung.held_out.rms_px)},
            {"geometric_mean", number(rung.typical_px)},
            {"scatter", number(rung.scatter_px)},
            {"folds", folds}}},
          {"gain_over_error", number(rung.gain_over_error)},
          {"moved", rung.moved}};
}

Json poses_json(const BoardCalibration& c) {
  Json poses = Json::array();
  for (const PoseDiagnosis& p : c.diagnosis.poses)
    poses.push_back({{"pose", p.label},
                     {"sightings", p.sightings},
                     {"fit_rms_px", p.fit_rms_px},
                     {"distance", number(p.distance)},
                     {"tilt_deg", number(p.tilt_deg)},
                     {"leverage_px", number(p.leverage_px)}});
  return poses;
}

Json dropped_json(const BoardCalibration& c) {
  Json dropped = Json::array();
  for (std::size_t i = 0; i < c.dropped.size(); ++i)
    dropped.push_back({{"device", c.dropped_devices[i]},
                       {"pose", c.dropped_poses[i]},
                       {"corner", c.dropped[i].corner},
                       {"residual_px", number(c.dropped_residual_px[i])}});
  return dropped;
}

// A column for each device.
template <class Cell>
std::string columns_text(std::size_t devices, const Cell& cell) {
  std::string text;
  for (std::size_t d = 0; d < devices; ++d) text += cell(d);
  return text;
}

std::string rung_text(const Rung& rung) {
  const std::size_t devices = rung.terms.size();
  std::string text = fmt::format(
      "  {} {}{:<4}", rung.chosen ? '*' : ' ',
      columns_text(devices, [&](std::size_t d) { return fmt::format("{:<18} ", terms_text(rung.terms[d])); }),
      rung.bend ? "yes" : "no");
  if (rung.fit_rms_px.empty()) return text + " does not converge\n";
  text += columns_text(devices, [&](std::size_t d) { return fmt::format(" {:>6.3f}", rung.fit_rms_px[d]); });
  if (rung.held_out.folds.empty())
    text += fmt::format("   {:>8} {:>9} {:>6}", "-", "-", "-");
  else
    text += fmt::format("   {:>8.4f} {:>9.3f} {:>+6.1f}", rung.held_out.rms_px, rung.scatter_px,
                        rung.gain_over_error);
  text += "  " + rung.moved;
  if (!rung.held_out.failed.empty()) text += fmt::format("  ({} folds fail)", rung.held_out.failed.size());
  return text + "\n";
}

std::string ladder_text(const Ladder& ladder, const std::vector<Device>& devices) {
  std::string text = "lens ladder; * is climbed\n    ";
  text +=
      columns_text(devices.size(), [&](std::size_t d) { return fmt::format("{:<18} ", devices[d].name); });
  text +=
      fmt::format("{:<4}{}   {:>8} {:>9} {:>6}  {}\n", "bend",
                  columns_text(devices.size(),
                               [](std::size_t d) { return fmt::format(" {:>6}", d == 0 ? "fit px" : ""); }),
                  "held-out", "± scatter", "gain/σ", "moved");
  for (const Rung& rung : ladder.rungs) text += rung_text(rung);
  return text;
}

double value_of(const BoardCalibration& c, std::size_t column) {
  const RigFit& fit = c.ladder.fit;
  const RigColumns columns = columns_of(fit.model);
  for (std::size_t d = 0; d < columns.devices.size(); ++d) {
    const RigColumns::Of& of = columns.devices[d];
    for (std::size_t i = 0; i < of.intrinsics.size(); ++i)
      if (of.intrinsics[i] == int(column)) return fit.adjustment.rig.devices[d].parameters[i];
    const int at = int(column) - of.pose;
    const Rigid& place = fit.adjustment.rig.devices[d].device_from_camera;
    if (of.pose >= 0 && at >= 0 && at < 6)
      return at < 3 ? rotation_vector_rad(place.rotation)[at] : place.translation[at - 3];
  }
  return fit.adjustment.rig.bend[int(column) - columns.bend];
}

std::string parameters_text(const BoardCalibration& c) {
  std::string text = fmt::format("{:<28} {:>14} {:>12}\n", "parameter", "value", "sigma");
  for (std::size_t i = 0; i < c.parameter_names.size(); ++i)
    text += fmt::format("{:<28} {:>14.8g} {:>12.3g}\n", c.parameter_names[i], value_of(c, i), c.sigma[i]);
  return text;
}

std::string poses_text(const BoardCalibration& c) {
  std::string text = fmt::format("{:<6} {:>12} {:>14} {:>9} {:>6} {:>10} {:>9}\n", "pose", "sightings",
                                 "fit px", "distance", "tilt", "held-out", "leverage");
  for (std::size_t k = 0; k < c.diagnosis.poses.size(); ++k) {
    const PoseDiagnosis& p = c.diagnosis.poses[k];
    std::string held_out = "-";
    for (const HeldOutPose& fold : c.held_out().folds)
      if (fold.pose == int(k)) held_out = fmt::format("{:.3f}", fold.rms_px);
    text += fmt::format("{:<6} {:>12} {:>14} {:>9.4g} {:>5.0f}° {:>10} {:>9}\n", p.label,
                        fmt::format("{}", fmt::join(p.sightings, "+")),
                        fmt::format("{:.3f}", fmt::join(p.fit_rms_px, " ")), p.distance, p.tilt_deg, held_out,
                        p.leverage_px ? fmt::format("{:.3f}", *p.leverage_px) : "-");
  }
  return text;
}

std::string sureness_text(const BoardCalibration& c) {
  std::string text = "standard deviation of predicted pixels (noise alone)\n";
  for (std::size_t d = 0; d < c.devices.size(); ++d) {
    const bool known = c.ladder.fit.capture.devices[d].known.has_value();
    const bool exact = c.ladder.fit.model.devices[d].known;
    text += fmt::format("  {}: sightings in {:.0f} % of the image{}\n", c.devices[d].name,
                        100 * c.diagnosis.devices[d].coverage,
                        !known  ? ""
                        : exact ? "; its known intrinsics are taken for exact"
                                : "; its known intrinsics are a prior, with their sigmas");
    for (const RangeSigma& r : c.diagnosis.devices[d].ranges)
      text += fmt::format("    range {:>9.4g}: centre {:.3f}, whole image {:.3f}, worst {:.3f} px\n", r.range,
                          r.center_px, r.rms_px, r.worst_px);
  }
  return text;
}

std::string summary_text(const BoardCalibration& c) {
  const Diagnosis& d = c.diagnosis;
  int projectors = 0;
  for (std::size_t n = 0; n < c.devices.size(); ++n) projectors += !is_camera(c.ladder.fit.capture, int(n));
  const std::string held_out = c.held_out().folds.empty() ? "-" : fmt::format("{:.4f}", c.held_out().rms_px);
  std::string text =
      fmt::format("fit {:.4f} px rms, held out {} px rms; {} iterations ({})\n", c.fit_rms_px(), held_out,
                  c.ladder.fit.adjustment.iterations, c.ladder.fit.adjustment.termination);
  text += fmt::format(
      "predicted error over {}'s volume, of points fixed on the boards: {:.3f} px by noise alone, {} px by "
      "leaving poses out; of points fixed in the camera's frame, which turns with its centre: {:.3f} px\n",
      projectors > 1 ? "the worst projector" : c.devices.back().name, d.predicted_volume_rms_px,
      d.jackknife_volume_rms_px ? fmt::format("{:.3f}", *d.jackknife_volume_rms_px) : "-",
      d.predicted_volume_camera_frame_rms_px);
  text += fmt::format("weakest: {} (sigma {:.2g} in natural units, gap {:.1g})\n", d.weakest_direction,
                      d.weakest_sigma, d.smallest_gap);
  for (const std::string& words : d.correlations) text += "  " + words + "\n";
  return text;
}

std::string dropped_text(const BoardCalibration& c) {
  std::string text;
  for (std::size_t i = 0; i < c.dropped.size(); ++i)
    text += fmt::format("dropped: pose {}, corner {}, {}: {:.2f} px off\n", c.dropped_poses[i],
                        c.dropped[i].corner, c.dropped_devices[i], c.dropped_residual_px[i]);
  if (!c.unused_poses.empty())
    text +=
        fmt::format("not used: pose {}: no camera sees 4 corners or more\n", fmt::join(c.unused_poses, ", "));
  return text;
}

}  // namespace

Json board_json(const BoardCalibration& c) {
  Json json = {{"status", status_word(c.status)}, {"reason", c.reason},
               {"fit_rms_px", nullptr},           {"held_out_px", nullptr},
               {"cameras", Json::array()},        {"projectors", Json::array()},
               {"dropped", dropped_json(c)},      {"unused_poses", c.unused_poses},
               {"ladder", Json::array()}};
  for (const Rung& rung : c.ladder.rungs) json["ladder"].push_back(rung_json(rung));
  if (!has_estimate(c)) return json;
  const Diagnosis& d = c.diagnosis;
  json["fit_rms_px"] = number(c.fit_rms_px());
  if (!c.held_out().folds.empty()) {
    Json folds = Json::array();
    for (const HeldOutPose& fold : c.held_out().folds) folds.push_back(number(fold.rms_px));
    json["held_out_px"] = {{"rms", number(c.held_out().rms_px)}, {"folds", folds}};
  }
  for (std::size_t n = 0; n < c.devices.size(); ++n)
    json[is_camera(c.ladder.fit.capture, int(n)) ? "cameras" : "projectors"].push_back(device_json(c, n));
  const glm::dvec2& bend = c.ladder.fit.adjustment.rig.bend;
  json["board_bend"] = {bend.x, bend.y};
  json["parameters"] = c.parameter_names;
  json["covariance"] = c.covariance.global;
  json["predicted_volume_px"] = {{"independent", number(d.predicted_volume_rms_px)},
                                 {"jackknife", number(d.jackknife_volume_rms_px)},
                                 {"camera_frame", number(d.predicted_volume_camera_frame_rms_px)}};
  json["weakest"] = {{"direction", d.weakest_direction},
                     {"sigma", number(d.weakest_sigma)},
                     {"gap", number(d.smallest_gap)}};
  json["correlations"] = d.correlations;
  json["poses"] = poses_json(c);
  json["iterations"] = c.ladder.fit.adjustment.iterations;
  json["termination"] = c.ladder.fit.adjustment.termination;
  return json;
}

std::string board_text(const BoardCalibration& c) {
  std::string text;
  if (has_estimate(c)) {
    text = ladder_text(c.ladder, c.devices) + "\n" + parameters_text(c) + "\n" + poses_text(c) + "\n" +
           sureness_text(c) + "\n" + summary_text(c);
  }
  text += dropped_text(c);
  return text +
         fmt::format("verdict: {}{}{}\n", status_word(c.status), c.reason.empty() ? "" : ": ", c.reason);
}

void add_placements(Json& json, const BoardFolders& folders) {
  json["placements"] = Json::array();
  for (const BoardPlacement& p : folders.placements) {
    Json projectors = Json::array();
    for (const BoardPlacement::Reading& r : p.projectors)
      projectors.push_back({{"name", r.projector},
                            {"points", r.reading.points},
                            {"median_residual_px", number(r.reading.median_residual_px)}});
    json["placements"].push_back({{"folder", p.folder},
                                  {"camera", p.camera},
                                  {"board", p.board},
                                  {"pose", p.pose},
                                  {"points", p.points},
                                  {"projectors", projectors}});
  }
  json["warnings"] = folders.warnings;
}

std::string placements_text(const BoardFolders& folders) {
  std::string text;
  if (!folders.placements.empty())
    text = fmt::format("{:<6} {:<28} {:>7}  {}\n", "pose", "folder", "points",
                       "camera, projector: points read, median residual of the local fits");
  for (const BoardPlacement& p : folders.placements) {
    text += fmt::format("{:<6} {:<28} {:>7}  {},", p.pose, p.folder, p.points, p.camera);
    for (const BoardPlacement::Reading& r : p.projectors)
      text += fmt::format(" {}: {}, {:.3f} px", r.projector, r.reading.points, r.reading.median_residual_px);
    text += "\n";
  }
  for (const std::string& warning : folders.warnings) text += fmt::format("warning: {}\n", warning);
  return text.empty() ? text : text + "\n";
}

Json methods_json(const std::vector<MethodResult>& results) {
  Json methods = Json::array();
  for (const MethodResult& r : results) {
    Json json = {{"method", r.name},
                 {"failure", r.failure},
                 {"seconds", number(r.seconds)},
                 {"over_bound", number(r.over_bound)}};
    if (r.rig) {
      Json folds = Json::array();
      for (const HeldOutPose& fold : r.held_out.folds) folds.push_back(number(fold.rms_px));
      const std::vector<double>& k = r.rig->devices.back().parameters;
      json["fit_rms_px"] = r.fit_rms_px;
      json["held_out_px"] = {
          {"rms", number(r.held_out.rms_px)}, {"folds", folds}, {"failed", r.held_out.failed.size()}};
      json["projector"] = {{"fx", k[0]}, {"fy", k[1]}, {"cx", k[2]}, {"cy", k[3]}};
    }
    methods.push_back(std::move(json));
  }
  return methods;
}

std::string methods_text(const std::vector<MethodResult>& results) {
  std::string text = fmt::format("{:<16} {:>14} {:>9} {:>10} {:>8} {:>9}  {}\n", "method", "fit px",
                                 "held-out", "over bound", "failures", "seconds", "projector fx, fy, cx, cy");
  for (const MethodResult& r : results) {
    if (!r.rig) {
      text += fmt::format("{:<16} {:>14} {:>9} {:>10} {:>8} {:>9}  {}\n", r.name, "-", "-", "-", "all", "-",
                          r.failure);
      continue;
    }
    const std::vector<double>& k = r.rig->devices.back().parameters;
    const std::string failures =
        fmt::format("{}/{}", r.held_out.failed.size(), r.held_out.failed.size() + r.held_out.folds.size());
    text += fmt::format("{:<16} {:>14} {:>9.4f} {:>10} {:>8} {:>9.4f}  {:.1f}, {:.1f}, {:.1f}, {:.1f}\n",
                        r.name, fmt::format("{:.3f}", fmt::join(r.fit_rms_px, " ")), r.held_out.rms_px,
                        r.over_bound ? fmt::format("{:.2f}", *r.over_bound) : "no truth", failures, r.seconds,
                        k[0], k[1], k[2], k[3]);
  }
  if (std::none_of(results.begin(), results.end(), [](const auto& r) { return r.over_bound.has_value(); }))
    text +=
        "over bound: the error over the least that noise allows, which takes a truth; of real sightings "
        "held-out is what tells methods apart\n";
  return text;
}

}  // namespace laterna
