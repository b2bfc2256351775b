#include "apps/lab/board_json.h"

#include "apps/lab/json_number.h"
#include "apps/lab/trial_report.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <utility>

namespace laterna {

using Json = nlohmann::json;

namespace {

// The sigmas of one device under their own names: "camera fx" is "fx" of the camera.
Json sigma_json(const BoardCalibration& c, const std::string& device) {
  Json json = Json::object();
  for (std::size_t i = 0; i < c.parameter_names.size(); ++i) {
    if (c.parameter_names[i].starts_with(device + " "))
      json[c.parameter_names[i].substr(device.size() + 1)] = finite_or_null(c.sigma[i]);
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
    json["prediction_sigma_px"].push_back({{"range", finite_or_null(r.range)},
                                           {"center", finite_or_null(r.center_px)},
                                           {"rms", finite_or_null(r.rms_px)},
                                           {"worst", finite_or_null(r.worst_px)}});
  if (d > 0) json["device_from_camera"] = rows_of(device.device_from_world);
  return json;
}

Json rung_json(const Rung& rung) {
  Json folds = Json::array(), lenses = Json::array();
  for (const HeldOutPose& fold : rung.held_out.folds) folds.push_back(finite_or_null(fold.rms_px));
  for (const auto& terms : rung.terms) lenses.push_back(terms_text(terms));
  return {{"lenses", lenses},
          {"board_bend", rung.bend},
          {"added", rung.added},
          {"chosen", rung.chosen},
          {"solved", rung.solved},
          {"fit_rms_px", rung.fit_rms_px},
          {"held_out_px",
           {{"rms", finite_or_null(rung.held_out.rms_px)},
            {"geometric_mean", finite_or_null(rung.typical_px)},
            {"scatter", finite_or_null(rung.scatter_px)},
            {"folds", folds}}},
          {"gain_over_error", finite_or_null(rung.gain_over_error)},
          {"moved", rung.moved}};
}

Json poses_json(const BoardCalibration& c) {
  Json poses = Json::array();
  for (const PoseDiagnosis& p : c.diagnosis.poses)
    poses.push_back({{"pose", p.label},
                     {"sightings", p.sightings},
                     {"fit_rms_px", p.fit_rms_px},
                     {"distance", finite_or_null(p.distance)},
                     {"tilt_deg", finite_or_null(p.tilt_deg)},
                     {"leverage_px", finite_or_null(p.leverage_px)}});
  return poses;
}

Json dropped_json(const BoardCalibration& c) {
  Json dropped = Json::array();
  for (std::size_t i = 0; i < c.dropped.size(); ++i)
    dropped.push_back({{"device", c.dropped_devices[i]},
                       {"pose", c.dropped_poses[i]},
                       {"corner", c.dropped[i].corner},
                       {"residual_px", finite_or_null(c.dropped_residual_px[i])}});
  return dropped;
}

}  // namespace

Json board_json(const BoardCalibration& c) {
  Json json = {{"status", status_word(c.status)}, {"reason", c.reason},
               {"fit_rms_px", nullptr},           {"held_out_px", nullptr},
               {"cameras", Json::array()},        {"projectors", Json::array()},
               {"dropped", dropped_json(c)},      {"unused_poses", c.unused_poses},
               {"ladder", Json::array()}};
  for (const Rung& rung : c.ladder.rungs) json["ladder"].push_back(rung_json(rung));
  if (c.status == Status::refused) return json;
  const Diagnosis& d = c.diagnosis;
  json["fit_rms_px"] = finite_or_null(c.fit_rms_px());
  if (!c.held_out().folds.empty()) {
    Json folds = Json::array();
    for (const HeldOutPose& fold : c.held_out().folds) folds.push_back(finite_or_null(fold.rms_px));
    json["held_out_px"] = {{"rms", finite_or_null(c.held_out().rms_px)}, {"folds", folds}};
  }
  for (std::size_t n = 0; n < c.devices.size(); ++n)
    json[is_camera(c.ladder.fit.capture, int(n)) ? "cameras" : "projectors"].push_back(device_json(c, n));
  const glm::dvec2& bend = c.ladder.fit.adjustment.rig.bend;
  json["board_bend"] = {bend.x, bend.y};
  json["parameters"] = c.parameter_names;
  json["covariance"] = c.covariance.global;
  json["predicted_volume_px"] = {{"independent", finite_or_null(d.predicted_volume_rms_px)},
                                 {"jackknife", finite_or_null(d.jackknife_volume_rms_px)},
                                 {"camera_frame", finite_or_null(d.predicted_volume_camera_frame_rms_px)}};
  json["weakest"] = {{"direction", d.weakest_direction},
                     {"sigma", finite_or_null(d.weakest_sigma)},
                     {"gap", finite_or_null(d.smallest_gap)}};
  json["correlations"] = d.correlations;
  json["poses"] = poses_json(c);
  json["iterations"] = c.ladder.fit.adjustment.iterations;
  json["termination"] = c.ladder.fit.adjustment.termination;
  return json;
}

void add_placements(Json& json, const BoardFolders& folders) {
  json["placements"] = Json::array();
  for (const BoardPlacement& p : folders.placements) {
    Json projectors = Json::array();
    for (const BoardPlacement::Reading& r : p.projectors)
      projectors.push_back({{"name", r.projector},
                            {"points", r.reading.points},
                            {"median_residual_px", finite_or_null(r.reading.median_residual_px)}});
    json["placements"].push_back({{"folder", p.folder},
                                  {"camera", p.camera},
                                  {"board", p.board},
                                  {"pose", p.pose},
                                  {"points", p.points},
                                  {"projectors", projectors}});
  }
  json["warnings"] = folders.warnings;
}

Json methods_json(const std::vector<MethodResult>& results) {
  Json methods = Json::array();
  for (const MethodResult& r : results) {
    Json json = {{"method", r.name},
                 {"failure", r.failure},
                 {"seconds", finite_or_null(r.seconds)},
                 {"over_bound", finite_or_null(r.over_bound)}};
    if (r.rig) {
      Json folds = Json::array();
      for (const HeldOutPose& fold : r.held_out.folds) folds.push_back(finite_or_null(fold.rms_px));
      const std::vector<double>& k = r.rig->devices.back().parameters;
      json["fit_rms_px"] = r.fit_rms_px;
      json["held_out_px"] = {
          {"rms", finite_or_null(r.held_out.rms_px)}, {"folds", folds}, {"failed", r.held_out.failed.size()}};
      json["projector"] = {{"fx", k[0]}, {"fy", k[1]}, {"cx", k[2]}, {"cy", k[3]}};
    }
    methods.push_back(std::move(json));
  }
  return methods;
}

}  // namespace laterna
