#include "apps/lab/score/cloud_score.h"
#include "apps/lab/trial_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace laterna {

namespace {

using Json = nlohmann::json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string line(const char* name, const char* unit, double error, double bound) {
  if (std::isnan(error)) return "";
  return fmt::format("  {:<10} {:>10.4g} {} {:>16.4g}\n", name, error, unit, bound);
}

std::string frame_words(const CloudScore& s) {
  if (s.better_frame.empty()) return "";
  return fmt::format("  the points fit {}as points in the frame of \"{}\": --frame {}\n",
                     s.suspects.empty() ? "" : "then ", s.better_frame, s.better_frame);
}

}  // namespace

Json cloud_score_json(const CloudScore& s) {
  Json suspects = Json::array();
  for (const Suspect& suspect : s.suspects)
    suspects.push_back({{"name", suspect.name}, {"explains", suspect.explains}});
  return {{"status", status_word(s.status)},
          {"surface_error_px", number(s.error.projector_px)},
          {"volume_error_px", nullptr},
          {"surface_error_mm", number(s.error.surface_mm)},
          {"point_error_mm", number(s.error.point_mm)},
          {"median_mm", number(s.median_mm)},
          {"p95_mm", number(s.p95_mm)},
          {"points", s.points},
          {"outliers", s.outliers},
          {"outlier_limit_mm", number(s.outlier_limit_mm)},
          {"no_true_point", s.no_true_point},
          {"suspects", suspects},
          {"bound",
           {{"surface_px", number(s.bound.projector_px)},
            {"volume_px", nullptr},
            {"surface_mm", number(s.bound.surface_mm)},
            {"point_mm", number(s.bound.point_mm)}}},
          {"predicted_volume_px", nullptr},
          {"alignment", alignment_word(s.alignment)},
          {"frame", s.frame.empty() ? "world" : s.frame},
          {"better_frame", s.better_frame.empty() ? Json(nullptr) : Json(s.better_frame)},
          {"projectors", Json::array()},
          {"warnings", Json::array()}};
}

std::string cloud_score_text(const CloudScore& s) {
  std::string text =
      fmt::format("{} points (frame: {}, aligned: {})\n  error                 rms   noise predicts\n",
                  s.points, s.frame.empty() ? "world" : s.frame, alignment_word(s.alignment));
  text += line("surface", "mm", s.error.surface_mm, s.bound.surface_mm);
  text += line("same pixel", "mm", s.error.point_mm, s.bound.point_mm);
  text += line("projector", "px", s.error.projector_px, s.bound.projector_px);
  text += fmt::format("  half of the points are within {:.4g} mm of the surface, 95 % within {:.4g} mm\n",
                      s.median_mm, s.p95_mm);
  text += fmt::format("  outliers: {} points ({:.3g} %) are farther than {:.4g} mm\n", s.outliers,
                      100 * double(s.outliers) / double(s.points), s.outlier_limit_mm);
  if (s.no_true_point)
    text += fmt::format("  {} points have a pixel that sees no surface\n", s.no_true_point);
  text += fmt::format("  verdict: {}{}\n", status_word(s.status),
                      s.status == Status::ok ? "" : ": wrong by more than noise explains");
  for (const Suspect& suspect : s.suspects)
    text += fmt::format("  {} explains {:.1f} %: {}\n", suspect.name, 100 * suspect.explains, suspect.words);
  text += frame_words(s);
  if (s.status != Status::ok && s.suspects.empty() && s.better_frame.empty())
    text += "  none of the usual suspects explains it\n";
  return text;
}

}  // namespace laterna
