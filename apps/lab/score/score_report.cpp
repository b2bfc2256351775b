#include "apps/lab/json_number.h"
#include "apps/lab/score/score.h"
#include "apps/lab/trial_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

using Json = nlohmann::json;

Json entry(const ProjectorScore& s) {
  Json suspects = Json::array();
  for (const Suspect& suspect : s.suspects)
    suspects.push_back({{"name", suspect.name}, {"explains", suspect.explains}});
  return {{"status", status_word(s.status)},
          {"surface_error_px", finite_or_null(s.surface_error_px)},
          {"volume_error_px", finite_or_null(s.volume_error_px)},
          {"surface_error_mm", finite_or_null(s.surface_error_mm)},
          {"camera_error_px", finite_or_null(s.camera_error_px)},
          {"suspects", suspects},
          {"bound",
           {{"surface_px", finite_or_null(s.surface_bound_px)},
            {"volume_px", finite_or_null(s.volume_bound_px)}}},
          {"predicted_volume_px", finite_or_null(s.predicted_volume_px)},
          {"alignment", alignment_word(s.alignment)}};
}

const ProjectorScore& worst(const std::vector<ProjectorScore>& scores) {
  return *std::max_element(scores.begin(), scores.end(), [](const auto& a, const auto& b) {
    return a.volume_error_px < b.volume_error_px;
  });
}

std::string suspects_of(const ProjectorScore& s) {
  std::string text;
  for (const Suspect& suspect : s.suspects)
    text += fmt::format("  {} explains {:.1f} %: {}\n", suspect.name, 100 * suspect.explains, suspect.words);
  return text;
}

std::string words_of(const ProjectorScore& s) {
  if (s.status == Status::refused)
    return fmt::format("projector \"{}\": the result says that it was refused\n{}", s.name, suspects_of(s));
  std::string text = fmt::format(
      "projector \"{}\" (aligned: {})\n"
      "  error                 rms   noise predicts\n"
      "  surface    {:>10.4g} px {:>16.4g}\n"
      "  volume     {:>10.4g} px {:>16.4g}\n"
      "  surface    {:>10.4g} mm\n"
      "{}"
      "  verdict: {}{}\n",
      s.name, alignment_word(s.alignment), s.surface_error_px, s.surface_bound_px, s.volume_error_px,
      s.volume_bound_px, s.surface_error_mm,
      std::isfinite(s.camera_error_px)
          ? fmt::format("  camera     {:>10.4g} px of its own\n", s.camera_error_px)
          : "",
      status_word(s.status), s.status == Status::weak ? ": wrong by more than noise explains" : "");
  text += suspects_of(s);
  if (s.status == Status::weak && s.suspects.empty()) text += "  none of the usual suspects explains it\n";
  return text;
}

}  // namespace

Json score_json(const std::vector<ProjectorScore>& scores, const Notes& warnings) {
  Json json = entry(worst(scores));
  json["warnings"] = warnings;
  json["projectors"] = Json::array();
  for (const ProjectorScore& s : scores) {
    json["projectors"].push_back(entry(s));
    json["projectors"].back()["name"] = s.name;
  }
  return json;
}

std::string score_text(const std::vector<ProjectorScore>& scores) {
  std::string text;
  for (const ProjectorScore& s : scores) text += words_of(s);
  return text;
}

}  // namespace laterna
