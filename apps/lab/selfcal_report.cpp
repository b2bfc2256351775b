#include "apps/lab/selfcal_report.h"

#include "apps/lab/json_number.h"
#include "apps/lab/trial_report.h"
#include "calib/boards/rig.h"
#include "calib/correspondences.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>

namespace laterna {

using Json = nlohmann::json;

namespace {

constexpr std::size_t most_points = 2000;

// fx, fy, cx, cy, k1, ...
std::string parameter_key(const SelfCalibration& c, std::size_t d, std::size_t i) {
  constexpr std::array<const char*, 4> keys = {"fx", "fy", "cx", "cy"};
  return i < keys.size() ? keys[i]
                         : lens_parameter_name(c.tracks.devices[d].lens.model, int(i - keys.size()));
}

Json ladder_json(const TrackLadder& ladder) {
  Json rungs = Json::array();
  for (const TrackRung& rung : ladder.rungs) {
    Json folds = Json::array();
    for (const HeldOutPose& fold : rung.held_out.folds) folds.push_back(finite_or_null(fold.rms_px));
    rungs.push_back({{"added", rung.added},
                     {"terms", rung.terms},
                     {"solved", rung.solved},
                     {"chosen", rung.chosen},
                     {"fit_rms_px", finite_or_null(rung.fit_rms_px)},
                     {"held_out_px", {{"rms", finite_or_null(rung.held_out.rms_px)}, {"folds", folds}}},
                     {"gain_over_error", finite_or_null(rung.gain_over_error)}});
  }
  return rungs;
}

std::string ladder_text(const TrackLadder& ladder) {
  if (ladder.rungs.empty()) return "";
  std::string text =
      fmt::format("  {:<24} {:>9} {:>12} {:>12}\n", "lens", "fit px", "held out px", "gain/error");
  for (const TrackRung& rung : ladder.rungs)
    text += fmt::format("{} {:<24} {:>9.4f} {:>12.4f} {:>12}\n", rung.chosen ? "*" : " ",
                        rung.added.empty() ? "as given" : "+ " + rung.added, rung.fit_rms_px,
                        rung.held_out.rms_px,
                        !rung.solved         ? "not solved"
                        : rung.added.empty() ? ""
                                             : fmt::format("{:.1f}", rung.gain_over_error));
  return text;
}

// " fx 1700.02 ± 0.3 fy ..."; terms that are held at 0 are passed over.
std::string parameters_text(const SelfCalibration& c, std::size_t d) {
  const Intrinsics& k = c.rig.devices[d];
  std::vector<double> values{k.fx, k.fy, k.cx, k.cy};
  values.insert(values.end(), c.rig.lenses[d].begin(), c.rig.lenses[d].end());
  const auto at = columns_of(c.tracks).intrinsics[d];
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i >= 4 && at[i] < 0 && values[i] == 0) continue;
    text += fmt::format(" {} {}{}", parameter_key(c, d, i),
                        i < 4 ? fmt::format("{:.2f}", values[i]) : fmt::format("{:.5f}", values[i]),
                        at[i] < 0 ? " (held)" : fmt::format(" ± {:.2g}", c.sigma[at[i]]));
  }
  return text;
}

Json device_json(const SelfCalibration& c, std::size_t d) {
  const Intrinsics& k = c.rig.devices[d];
  const std::string& name = c.tracks.devices[d].name;
  Json sigma = Json::object();
  const auto at = columns_of(c.tracks).intrinsics[d];
  for (std::size_t i = 0; i < at.size(); ++i)
    if (at[i] >= 0) sigma[parameter_key(c, d, i)] = finite_or_null(c.sigma[at[i]]);
  return {{"name", name},
          {"size", {k.size.x, k.size.y}},
          {"fx", k.fx},
          {"fy", k.fy},
          {"cx", k.cx},
          {"cy", k.cy},
          {"lens", {{"model", c.tracks.devices[d].lens.model}, {"parameters", c.rig.lenses[d]}}},
          {"sigma", sigma}};
}

Json station_json(const SelfCalibration& c, std::size_t s) {
  const StationReport& r = c.stations[s];
  return {{"device", c.tracks.devices[c.tracks.stations[s].device].name},
          {"station", c.tracks.stations[s].name},
          {"device_from_first", rows_of(c.rig.station_from_first[s])},
          {"sightings", r.sightings},
          {"fit_rms_px", finite_or_null(r.rms_px)},
          {"predicted_px", finite_or_null(r.predicted_px)}};
}

// To look at: those that were placed, thinned.
Json points_json(const SelfCalibration& c) {
  std::vector<int> placed;
  for (int p = 0; p < int(c.rig.points.size()); ++p)
    if (c.rig.has_point(p)) placed.push_back(p);
  Json points = Json::array();
  for (const std::size_t k : evenly_spread(placed.size(), most_points)) {
    const glm::dvec3& x = c.rig.points[std::size_t(placed[k])];
    points.push_back({finite_or_null(x.x), finite_or_null(x.y), finite_or_null(x.z)});
  }
  return points;
}

std::string unit_text(const SelfCalibration& c) {
  if (c.metric) return "lengths in metres, by the known length";
  std::string text = "up to scale:";
  for (const auto& [a, b] : c.units)
    text +=
        fmt::format(" the distance from {} to {} is 1;", c.tracks.station_name(a), c.tracks.station_name(b));
  text.pop_back();
  return text;
}

}  // namespace

Json selfcal_json(const SelfCalibration& c) {
  Json json = {{"status", status_word(c.status)},
               {"reason", c.reason},
               {"count",
                {{"given", c.count.given},
                 {"needed", c.count.needed()},
                 {"intrinsics", c.count.intrinsics},
                 {"places", c.count.places}}},
               {"merged", c.merged},
               {"fit_rms_px", nullptr},
               {"devices", Json::array()},
               {"stations", Json::array()},
               {"dropped", Json::array()}};
  for (const DroppedSighting& d : c.dropped)
    json["dropped"].push_back({{"point", c.tracks.point_names[d.sighting.point]},
                               {"station", c.tracks.station_name(d.sighting.station)},
                               {"residual_sigmas", finite_or_null(d.residual_sigmas)}});
  if (!c.weakest_direction.empty())
    json["weakest"] = {{"direction", c.weakest_direction},
                       {"sigma", finite_or_null(c.weakest_sigma)},
                       {"gap", finite_or_null(c.smallest_gap)}};
  if (c.status == Status::refused) return json;
  json["unit"] = c.metric ? "metre" : "baseline";
  json["unit_baselines"] = Json::array();
  for (const auto& [a, b] : c.units)
    json["unit_baselines"].push_back({c.tracks.station_name(a), c.tracks.station_name(b)});
  json["fit_rms_px"] = finite_or_null(c.fit_rms_px);
  json["residual_scale"] = finite_or_null(c.residual_scale);
  json["focal_sigma"] = finite_or_null(c.focal_sigma);
  json["lens_sigma"] = finite_or_null(c.lens_sigma);
  json["ladder"] = ladder_json(c.ladder);
  for (std::size_t d = 0; d < c.rig.devices.size(); ++d) json["devices"].push_back(device_json(c, d));
  for (std::size_t s = 0; s < c.stations.size(); ++s) json["stations"].push_back(station_json(c, s));
  json["points"] = points_json(c);
  json["parameters"] = c.parameter_names;
  json["covariance"] = c.covariance;
  json["iterations"] = c.iterations;
  json["termination"] = c.termination;
  return json;
}

std::string selfcal_text(const SelfCalibration& c) {
  std::string text =
      fmt::format("the pixels give {} numbers; {} are asked for: {} of intrinsics, {} of places\n",
                  c.count.given, c.count.needed(), c.count.intrinsics, c.count.places);
  for (const std::string& words : c.merged) text += words + "\n";
  if (!c.dropped.empty()) text += fmt::format("dropped as outliers: {} sightings\n", c.dropped.size());
  if (c.status != Status::refused) {
    text += ladder_text(c.ladder);
    for (std::size_t d = 0; d < c.rig.devices.size(); ++d)
      text += c.tracks.devices[d].name + ":" + parameters_text(c, d) + "\n";
    for (std::size_t s = 0; s < c.stations.size(); ++s)
      text += fmt::format("  {:<24} {:>7} sightings, fit {:.4f} px rms, predicted to {:.3f} px\n",
                          c.tracks.station_name(int(s)), c.stations[s].sightings, c.stations[s].rms_px,
                          c.stations[s].predicted_px);
    text += fmt::format("{}\n{} iterations ({})\n", unit_text(c), c.iterations, c.termination);
  }
  if (!c.weakest_direction.empty())
    text += fmt::format("weakest: {} (sigma {:.2g} in natural units, gap {:.1g})\n", c.weakest_direction,
                        c.weakest_sigma, c.smallest_gap);
  return text +
         fmt::format("verdict: {}{}{}\n", status_word(c.status), c.reason.empty() ? "" : ": ", c.reason);
}

}  // namespace laterna
