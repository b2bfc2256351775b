#include "calib/selfcal/self_calibrate.h"

#include "calib/selfcal/adjust_tracks.h"
#include "calib/selfcal/turned.h"
#include "sim/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

const RobustLoss cauchy{RobustLoss::Kind::cauchy, 2};

struct Solution {
  TrackAdjustment adjustment;
  std::vector<UnitBaseline> units;
};

// About `wanted` points, evenly spread, with all their sightings.
Tracks some_points(const Tracks& tracks, std::size_t wanted) {
  std::vector<int> seen;  // points with sightings, in order
  for (const TrackSighting& s : tracks.sightings)
    if (seen.empty() || seen.back() != s.point) seen.push_back(s.point);
  std::vector<char> keep(tracks.point_names.size(), 0);
  for (const std::size_t i : evenly_spread(seen.size(), wanted)) keep[seen[i]] = 1;
  Tracks some = tracks;
  std::erase_if(some.sightings, [&](const TrackSighting& s) { return !keep[s.point]; });
  return some;
}

// The loss with what is not placed counted as outliers, so that solutions compare.
double full_loss(const Tracks& tracks, const TrackAdjustment& a) {
  double missing = 0;
  for (const TrackSighting& s : tracks.sightings) missing += !a.rig.has_point(s.point);
  return a.loss + missing * cauchy.rho(100);
}

std::optional<Solution> solve_from(const Tracks& tracks, const Reconstruction& start, int unlinked,
                                   int max_iterations, double function_tolerance) {
  std::vector<UnitBaseline> units = start.units;
  units.resize(std::min<std::size_t>(units.size(), std::size_t(std::max(1, unlinked))));
  TrackRig rig = start.rig;
  place_missing_points(tracks, rig);
  std::optional<TrackAdjustment> a;
  for (int round = 0; round < 2; ++round) {
    a = adjust_tracks(tracks, rig, units, cauchy, max_iterations, function_tolerance);
    if (!a) return std::nullopt;
    rig = a->rig;
    place_missing_points(tracks, rig);
  }
  return Solution{std::move(*a), std::move(units)};
}

bool differ(const TrackRig& a, const TrackRig& b, double share) {
  for (std::size_t d = 0; d < a.devices.size(); ++d)
    if (std::abs(a.devices[d].fx / b.devices[d].fx - 1) > share) return true;
  return false;
}

// Solutions on all points from the best different ones on some points; best first.
std::vector<Solution> solve_all(const Tracks& tracks, const std::vector<SolvedPair>& pairs, int unlinked) {
  const Tracks some = some_points(tracks, 60 * std::size_t(tracks.station_count() - 1));
  std::vector<std::pair<double, Solution>> first;
  for (const auto& guess : intrinsics_guesses(pairs, tracks, 8)) {
    const auto start = reconstruct(pairs, some, guess);
    if (!start) continue;
    if (auto s = solve_from(some, *start, unlinked, 60, 1e-3)) {
      const double loss = full_loss(some, s->adjustment);
      first.emplace_back(loss, std::move(*s));
    }
  }
  std::stable_sort(first.begin(), first.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Solution> all;
  std::vector<TrackRig> tried;
  for (const auto& [loss, s] : first) {
    const bool known =
        std::any_of(tried.begin(), tried.end(),
                    [&, &rig = s.adjustment.rig](const TrackRig& t) { return !differ(t, rig, 0.03); });
    if (known || tried.size() == 3) continue;
    tried.push_back(s.adjustment.rig);
    if (auto solution = solve_from(tracks, {s.adjustment.rig, s.units}, unlinked, 200, 1e-8))
      all.push_back(std::move(*solution));
  }
  std::stable_sort(all.begin(), all.end(), [&](const auto& a, const auto& b) {
    return full_loss(tracks, a.adjustment) < full_loss(tracks, b.adjustment);
  });
  return all;
}

// Degrees of freedom of a fit.
double freedom(const Tracks& tracks, const std::vector<UnitBaseline>& units) {
  int points = 0;
  for (std::size_t i = 0; i < tracks.sightings.size(); ++i)
    points += i == 0 || tracks.sightings[i - 1].point != tracks.sightings[i].point;
  return 2.0 * double(tracks.sightings.size()) - 3.0 * points - columns_of(tracks).count +
         double(units.size());
}

double variance_of(const Tracks& tracks, const TrackRig& rig, const std::vector<UnitBaseline>& units) {
  double sum = 0;
  for (const double r : scaled_residuals(tracks, rig)) sum += r * r;
  return sum / std::max(1.0, freedom(tracks, units));
}

// Drops misfits until there are none, with least squares on the rest. None where it fails, else whether it
// converged.
std::optional<bool> refine(SelfCalibration& c, const Solution& solution) {
  TrackRig rig = solution.adjustment.rig;
  place_missing_points(c.tracks, rig);
  for (int round = 0; round < 8; ++round) {
    std::vector<double> r = scaled_residuals(c.tracks, rig);
    const auto middle = r.begin() + std::ptrdiff_t(r.size() / 2);
    std::nth_element(r.begin(), middle, r.end());
    // Half of the sightings' r lie below 0.48 sigma for pairs, below 1.18 for long tracks.
    const double variance = std::max(1.0, std::pow(*middle / 0.48, 2));
    auto dropped = drop_misfits(c.tracks, rig,
                                round < 2 ? variance : std::max(1.0, variance_of(c.tracks, rig, c.units)));
    if (c.tracks.sightings.empty()) return std::nullopt;
    const auto a = adjust_tracks(c.tracks, rig, c.units, {}, 500);
    if (!a) return std::nullopt;
    rig = c.rig = a->rig;
    c.iterations = a->iterations, c.termination = a->termination;
    const bool done = dropped.empty() && round >= 2;
    std::move(dropped.begin(), dropped.end(), std::back_inserter(c.dropped));
    if (done || !a->converged) return a->converged;
  }
  return true;
}

double largest_focal_sigma(const SelfCalibration& c) {
  const TrackColumns columns = columns_of(c.tracks);
  double largest = 0;
  for (std::size_t d = 0; d < columns.intrinsics.size(); ++d)
    for (const int at : columns.intrinsics[d])
      if (at >= 0) largest = std::max(largest, c.sigma[at] / std::abs(c.rig.devices[d].fx));
  return largest;
}

void describe(SelfCalibration& c, const SelfCalibrationOptions& options) {
  const double variance = variance_of(c.tracks, c.rig, c.units);
  c.residual_scale = std::sqrt(variance);
  const double used = std::max(1.0, variance);
  TrackCovariance covariance = track_covariance(c.tracks, c.rig, c.units, used);
  c.smallest_gap = covariance.smallest_gap;
  c.weakest_sigma = covariance.weakest_sigma, c.weakest_direction = covariance.weakest_direction;
  c.parameter_names = column_names(c.tracks);
  c.covariance = covariance.global;
  c.stations.assign(c.tracks.stations.size(), {});
  double sum = 0;
  const std::vector<double> r = scaled_residuals(c.tracks, c.rig);
  for (std::size_t i = 0; i < r.size(); ++i) {
    const TrackSighting& s = c.tracks.sightings[i];
    ++c.stations[s.station].sightings;
    c.stations[s.station].rms_px += std::pow(r[i] * s.sigma_px, 2);
    sum += std::pow(r[i] * s.sigma_px, 2);
  }
  c.fit_rms_px = std::sqrt(sum / double(r.size()));
  for (std::size_t s = 0; s < c.stations.size(); ++s) {
    c.stations[s].rms_px = std::sqrt(c.stations[s].rms_px / std::max(1.0, double(c.stations[s].sightings)));
    c.stations[s].predicted_px =
        c.covariance.empty() ? INFINITY : predicted_px(c.tracks, c.rig, c.covariance, int(s));
  }
  c.focal_sigma = INFINITY;
  if (c.covariance.empty()) return;
  if (options.length) c.metric = scale_to(*options.length, c.tracks, used, c.rig, c.covariance);
  const std::size_t n = c.parameter_names.size();
  for (std::size_t i = 0; i < n; ++i) c.sigma.push_back(std::sqrt(c.covariance[i * n + i]));
  c.focal_sigma = largest_focal_sigma(c);
}

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

void refuse(SelfCalibration& c, std::string reason) {
  c.status = Status::refused;
  c.reason = std::move(reason);
}

// What leaves a solution that cannot be believed; empty where nothing does.
std::string refusal(const SelfCalibration& c, const std::vector<SolvedPair>& pairs,
                    const SelfCalibrationOptions& options) {
  if (c.focal_sigma <= options.refused_focal) return {};
  if (const auto reason = meeting_axes(c.tracks, pairs)) return *reason;
  return fmt::format(
      "the points and placements do not determine what is asked for: {} (sigma {:.2g} in natural "
      "units, gap {:.1g}); add placements in other directions, or points at other depths",
      c.weakest_direction, c.weakest_sigma, c.smallest_gap);
}

std::string weakness(const SelfCalibration& c, const SelfCalibrationOptions& options, std::size_t sightings) {
  std::vector<std::string> reasons;
  if (c.focal_sigma > options.weak_focal)
    reasons.push_back(fmt::format("intrinsics are known to {:.1f} % of f only: {}", 100 * c.focal_sigma,
                                  c.weakest_direction));
  for (std::size_t s = 0; s < c.stations.size(); ++s)
    if (!(c.stations[s].predicted_px <= options.tolerance_px))
      reasons.push_back(fmt::format("pixels of {} are predicted to {:.2g} px only",
                                    c.tracks.station_name(int(s)), c.stations[s].predicted_px));
  if (c.tracks.has_sigma && c.residual_scale > 2)
    reasons.push_back(
        fmt::format("residuals are {:.1f} times what the sigmas explain: a lens that is no pinhole, "
                    "or points that moved",
                    c.residual_scale));
  if (double(c.dropped.size()) > 0.3 * double(sightings))
    reasons.push_back(fmt::format("{:.0f} % of the sightings are outliers",
                                  100.0 * double(c.dropped.size()) / double(sightings)));
  return fmt::format("{}", fmt::join(reasons, "; "));
}

// Another solution that fits as well.
std::string ambiguity(const std::vector<Solution>& all, const Tracks& tracks, double variance) {
  for (std::size_t i = 1; i < all.size(); ++i) {
    const TrackAdjustment &a = all[0].adjustment, &b = all[i].adjustment;
    if (differ(a.rig, b.rig, 0.05) && full_loss(tracks, b) < full_loss(tracks, a) + 16 * variance)
      return fmt::format("two different solutions explain the points: f of {} is {:.1f} or {:.1f}",
                         tracks.devices.back().name, a.rig.devices.back().fx, b.rig.devices.back().fx);
  }
  return {};
}

void check_length(const Tracks& tracks, const KnownLength& length) {
  const auto known = [&](int p) { return p >= 0 && p < tracks.point_count(); };
  if (!known(length.point_a) || !known(length.point_b) || length.point_a == length.point_b ||
      !(length.metres > 0 && std::isfinite(length.metres)))
    throw InputError(
        fmt::format("length: {} between points {} and {}, expected a positive number between two "
                    "points of the table",
                    length.metres, length.point_a, length.point_b));
}

void solve_and_judge(SelfCalibration& c, std::vector<SolvedPair>& pairs,
                     const SelfCalibrationOptions& options, std::size_t sightings) {
  if (strongest_pair(pairs).geometry.homography_explains)
    return refuse(c, homography_reason(c.tracks, strongest_pair(pairs)));
  const std::vector<Solution> all = solve_all(c.tracks, pairs, c.count.unlinked);
  if (all.empty()) return refuse(c, "no placement of the devices explains the points");
  c.units = all.front().units;
  const Tracks before = c.tracks;
  const auto converged = refine(c, all.front());
  if (!converged) return refuse(c, "no placement of the devices explains the points");
  describe(c, options);
  std::string reason = refusal(c, pairs, options);
  if (reason.empty() && !*converged) reason = "the adjustment does not converge: " + c.termination;
  if (reason.empty()) reason = ambiguity(all, before, std::max(1.0, c.residual_scale * c.residual_scale));
  if (reason.empty() && options.length && !c.metric)
    reason = "the points of the known length are not placed: too few stations see them, or they are outliers";
  if (reason.empty() && options.length && c.units.size() > 1)
    reason = fmt::format(
        "{} baselines have lengths of their own, which one known length does not join: let three "
        "stations share points",
        c.units.size());
  if (!reason.empty()) return refuse(c, reason);
  c.reason = weakness(c, options, sightings);
  c.status = c.reason.empty() ? Status::ok : Status::weak;
}

}  // namespace

SelfCalibration self_calibrate(const Tracks& tracks, const SelfCalibrationOptions& options) {
  SelfCalibration c;
  c.tracks = tracks;
  c.count = count_numbers(tracks);  // validates
  if (options.length) check_length(tracks, *options.length);
  if (const std::string shortage = shortage_in_words(tracks, c.count); !shortage.empty()) {
    refuse(c, shortage);
    return c;
  }
  try {
    c.merged = merge_stations(c.tracks);
    c.count = count_numbers(c.tracks);
    if (const std::string shortage = shortage_in_words(c.tracks, c.count); !shortage.empty()) {
      refuse(c, fmt::format("{}; {}", fmt::join(c.merged, "; "), shortage));
      return c;
    }
    std::vector<SolvedPair> pairs = solve_pairs(c.tracks);
    if (pairs.empty()) throw Refusal("too few points: no two stations share 8");
    c.dropped = drop_pair_outliers(c.tracks, pairs);
    solve_and_judge(c, pairs, options, tracks.sightings.size());
  } catch (const Refusal& refusal) {
    refuse(c, refusal.what());
  }
  return c;
}

}  // namespace laterna
