#include "calib/selfcal/selfcal_verdict.h"

#include "calib/selfcal/critical_pair.h"
#include "calib/selfcal/turned.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

// Both focal lengths of one pair with axes that meet, or nearly; none where that is not it.
std::optional<std::string> meeting_axes(const Tracks& tracks, const std::vector<SolvedPair>& pairs) {
  if (pairs.size() != 1) return std::nullopt;
  const SolvedPair& p = pairs.front();
  const TrackDevice &a = tracks.devices[tracks.stations[p.pair.a].device],
                    &b = tracks.devices[tracks.stations[p.pair.b].device];
  const glm::dvec2 ca(a.intrinsics.cx, a.intrinsics.cy), cb(b.intrinsics.cx, b.intrinsics.cy);
  const double miss = axes_miss_px(p.geometry.fundamental, ca, cb);
  if (!a.focal || !b.focal || a.center || b.center || miss > 0.03 * b.intrinsics.size.x) return std::nullopt;
  return fmt::format(
      "both focal lengths are not determined where the optical axes meet: those of {} and {} miss "
      "each other by {:.2g} px only; know one focal length, or turn one device aside",
      a.name, b.name, miss);
}

// χ² with so many degrees of freedom is above it once in 10⁵ (Wilson and Hilferty 1931), as in solve().
double chi2_once_in_1e5(int dof) {
  const double a = 2.0 / (9.0 * dof);
  return dof * std::pow(1 - a + 4.265 * std::sqrt(a), 3);
}

// The residuals follow a lens that was not asked for, by more than what is predicted anyway.
std::string lens_reason(const SelfCalibration& c) {
  const TrackLensLeftOut& left = c.lens_left_out;
  if (left.terms == 0 || left.chi2 < chi2_once_in_1e5(left.terms)) return {};
  double predicted = 0;
  for (std::size_t s = 0; s < c.stations.size(); ++s)
    if (c.tracks.devices[c.tracks.stations[s].device].name == left.device)
      predicted = std::max(predicted, c.stations[s].predicted_px);
  if (!(left.moved_px > 2 * predicted)) return {};
  return fmt::format(
      "the residuals follow a lens that was not asked for: k1 = {:.2g}, k2, p1 and p2 of {} would move its "
      "pixels by {:.2g} px, where {:.2g} px are predicted",
      left.k1, left.device, left.moved_px, predicted);
}

}  // namespace

std::string homography_reason(const Tracks& tracks, const SolvedPair& p) {
  const TrackDevice &a = tracks.devices[tracks.stations[p.pair.a].device],
                    &b = tracks.devices[tracks.stations[p.pair.b].device];
  const std::string where = fmt::format("the {} points that {} and {} share", p.pair.size(),
                                        tracks.station_name(p.pair.a), tracks.station_name(p.pair.b));
  const auto turned = turned_scale(p.pair, a, b, p.geometry.homography);
  // A turn fits as well as any homography, but for its fewer parameters: within a factor of 1.5.
  if (!turned)
    return fmt::format(
        "a homography explains {}: the scene is a plane, or the devices stand in one place; "
        "neither tells the intrinsics",
        where);
  if (*turned < 1.5 * std::max(1.0, p.geometry.homography_scale))
    return fmt::format(
        "no baseline: a turn alone explains {}, so that nothing tells of depth; move the devices "
        "apart",
        where);
  return fmt::format(
      "the scene is a plane: a homography explains {} ({:.2f} sigma rms, {:.2f} for any scene); "
      "show a scene with relief",
      where, p.geometry.homography_scale, p.geometry.epipolar_scale);
}

std::string critical_reason(const Tracks& tracks, const std::vector<SolvedPair>& pairs) {
  const auto critical = [](const SolvedPair& p) { return on_critical_surface(p.pair, p.geometry); };
  if (pairs.empty() || !std::all_of(pairs.begin(), pairs.end(), critical)) return {};
  const SolvedPair& p = strongest_pair(pairs);
  return fmt::format(
      "the points lie near a critical surface: a quadric through the centres of {} and {}, on which other "
      "placements explain the same pixels; add points off it",
      tracks.station_name(p.pair.a), tracks.station_name(p.pair.b));
}

std::string refusal_reason(const SelfCalibration& c, const std::vector<SolvedPair>& pairs,
                           const SelfCalibrationOptions& options) {
  if (c.focal_sigma <= options.refused_focal && c.lens_sigma <= options.refused_focal) return {};
  if (const auto reason = meeting_axes(c.tracks, pairs)) return *reason;
  if (const std::string reason = critical_reason(c.tracks, pairs); !reason.empty()) return reason;
  return fmt::format(
      "the points and placements do not determine what is asked for: {} (sigma {:.2g} in natural "
      "units, gap {:.1g}); add placements in other directions, or points at other depths",
      c.weakest_direction, c.weakest_sigma, c.smallest_gap);
}

std::string weakness_reason(const SelfCalibration& c, const std::vector<SolvedPair>& pairs,
                            const SelfCalibrationOptions& options, std::size_t sightings) {
  std::vector<std::string> reasons;
  if (const std::string reason = critical_reason(c.tracks, pairs); !reason.empty()) reasons.push_back(reason);
  if (c.focal_sigma > options.weak_focal)
    reasons.push_back(fmt::format("intrinsics are known to {:.1f} % of f only: {}", 100 * c.focal_sigma,
                                  c.weakest_direction));
  if (c.lens_sigma > options.weak_focal)
    reasons.push_back(fmt::format("lens terms are known to {:.1f} % of f at the image's corner only: {}",
                                  100 * c.lens_sigma, c.weakest_direction));
  for (const std::string& name : folded_lenses(c.tracks, c.rig))
    reasons.push_back(fmt::format("the estimated lens maps no ray to parts of the image of {}", name));
  for (std::size_t s = 0; s < c.stations.size(); ++s)
    if (!(c.stations[s].predicted_px <= options.tolerance_px))
      reasons.push_back(fmt::format("pixels of {} are predicted to {:.2g} px only",
                                    c.tracks.station_name(int(s)), c.stations[s].predicted_px));
  if (c.tracks.has_sigma && c.residual_scale > 2)
    reasons.push_back(
        fmt::format("residuals are {:.1f} times what the sigmas explain: a lens that is no pinhole, "
                    "or points that moved",
                    c.residual_scale));
  if (const std::string lens = lens_reason(c); !lens.empty()) reasons.push_back(lens);
  if (double(c.dropped.size()) > 0.3 * double(sightings))
    reasons.push_back(fmt::format("{:.0f} % of the sightings are outliers",
                                  100.0 * double(c.dropped.size()) / double(sightings)));
  return fmt::format("{}", fmt::join(reasons, "; "));
}

}  // namespace laterna
