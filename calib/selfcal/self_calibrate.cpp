#include "calib/selfcal/self_calibrate.h"

#include "calib/selfcal/adjust_tracks.h"
#include "calib/selfcal/selfcal_verdict.h"
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

int lens_free_count(const Tracks& tracks) {
  int count = 0;
  for (const TrackDevice& d : tracks.devices) count += d.lens_free_count();
  return count;
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

// The devices' lenses in place of pinholes: known ones as they are; terms that are free, or climb in,
// adjusted for each solution, best first; the climb goes from the best.
void add_lenses(SelfCalibration& c, std::vector<Solution>& all, const std::vector<TrackDevice>& devices) {
  put_lenses_back(devices, c.tracks);
  for (DroppedSighting& d : c.dropped)
    if (std::isfinite(d.residual_sigmas))  // else the pixel is as it was given
      put_lens_back(devices[c.tracks.stations[d.sighting.station].device], d.sighting.pixel);
  const auto adjust = [&](Solution& s) {
    for (std::size_t d = 0; d < devices.size(); ++d) {
      auto& lens = s.adjustment.rig.lenses[d];
      if (lens.empty()) lens = devices[d].lens.parameters;
      lens.resize(c.tracks.devices[d].lens.parameters.size(), 0.0);
    }
    if (lens_free_count(c.tracks) == 0) return true;
    auto better = solve_from(c.tracks, {s.adjustment.rig, s.units}, c.count.unlinked, 200, 1e-10);
    if (better) s = std::move(*better);
    return better.has_value();
  };
  const auto adjust_all = [&] {
    std::erase_if(all, [&](Solution& s) { return !adjust(s); });
    std::stable_sort(all.begin(), all.end(), [&](const auto& a, const auto& b) {
      return full_loss(c.tracks, a.adjustment) < full_loss(c.tracks, b.adjustment);
    });
  };
  adjust_all();
  if (all.empty()) return;
  c.ladder = climb_lenses(c.tracks, all.front().adjustment.rig, all.front().units, cauchy);
  if (c.ladder.winner > 0) adjust_all();
}

// Sightings that pinholes had no room for, and lenses have, come back; others stay dropped.
void readmit(SelfCalibration& c, const TrackRig& rig) {
  if (lens_free_count(c.tracks) == 0) return;
  Tracks with = c.tracks;
  for (const DroppedSighting& d : c.dropped)
    if (std::isfinite(d.residual_sigmas)) with.sightings.push_back(d.sighting);
  const auto key = [](const TrackSighting& s) { return std::pair(s.point, s.station); };
  std::stable_sort(with.sightings.begin(), with.sightings.end(),
                   [&](const auto& a, const auto& b) { return key(a) < key(b); });
  TrackRig placed = rig;
  place_missing_points(with, placed);
  const std::vector<double> r = scaled_residuals(with, placed);
  std::vector<double> sorted = scaled_residuals(c.tracks, placed);
  const auto middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double limit = 4 * std::max(1.0, *middle / 0.48);  // as in refine()
  for (std::size_t i = 0; i < r.size(); ++i) {
    const auto was = std::find_if(c.dropped.begin(), c.dropped.end(), [&](const DroppedSighting& d) {
      return key(d.sighting) == key(with.sightings[i]);
    });
    if (was == c.dropped.end() || r[i] > limit) continue;
    c.tracks.sightings.push_back(with.sightings[i]);
    c.dropped.erase(was);
  }
  std::stable_sort(c.tracks.sightings.begin(), c.tracks.sightings.end(),
                   [&](const auto& a, const auto& b) { return key(a) < key(b); });
}

// Drops misfits until there are none, with least squares on the rest. None where it fails, else whether it
// converged.
std::optional<bool> refine(SelfCalibration& c, TrackRig rig) {
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
    for (int i = 0; i < 4; ++i)
      if (const int at = columns.intrinsics[d][i]; at >= 0)
        largest = std::max(largest, c.sigma[at] / std::abs(c.rig.devices[d].fx));
  return largest;
}

void describe(SelfCalibration& c, const SelfCalibrationOptions& options) {
  const double variance = variance_of(c.tracks, c.rig, c.units);
  c.residual_scale = std::sqrt(variance);
  const double used = std::max(1.0, variance);
  TrackCovariance covariance = track_covariance(c.tracks, c.rig, c.units, used);
  c.sigma.clear();
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
  c.lens_left_out = track_lens_left_out(c.tracks, c.rig, c.units, used);
  if (options.length) c.metric = scale_to(*options.length, c.tracks, used, c.rig, c.covariance);
  const std::size_t n = c.parameter_names.size();
  for (std::size_t i = 0; i < n; ++i) c.sigma.push_back(std::sqrt(c.covariance[i * n + i]));
  c.focal_sigma = largest_focal_sigma(c);
  c.lens_sigma = largest_lens_sigma(c.tracks, c.rig, c.sigma);
}

void refuse(SelfCalibration& c, std::string reason) {
  c.status = Status::refused;
  c.reason = std::move(reason);
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
                     const SelfCalibrationOptions& options, const std::vector<TrackDevice>& devices,
                     std::size_t sightings) {
  if (strongest_pair(pairs).geometry.homography_explains)
    return refuse(c, homography_reason(c.tracks, strongest_pair(pairs)));
  std::vector<Solution> all = solve_all(c.tracks, pairs, c.count.unlinked);
  add_lenses(c, all, devices);
  const std::string critical = critical_reason(c.tracks, pairs);
  const std::string none = critical.empty() ? "no placement of the devices explains the points" : critical;
  if (all.empty()) return refuse(c, none);
  c.units = all.front().units;
  const Tracks before = c.tracks;
  readmit(c, all.front().adjustment.rig);
  auto converged = refine(c, all.front().adjustment.rig);
  if (converged && !c.tracks.has_sigma && lens_free_count(c.tracks) > 0) {
    // The pairs took the lens for noise.
    const double scale = std::sqrt(variance_of(c.tracks, c.rig, c.units));
    for (TrackSighting& s : c.tracks.sightings) s.sigma_px = std::max(0.01, s.sigma_px * scale);
    converged = refine(c, c.rig);
  }
  if (!converged) return refuse(c, none);
  describe(c, options);
  std::string reason = refusal_reason(c, pairs, options);
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
  c.reason = weakness_reason(c, pairs, options, sightings);
  c.status = c.reason.empty() ? Status::ok : Status::weak;
}

// Stations have gone: sightings that were left out before get the one that is left of their device.
void name_anew(std::vector<DroppedSighting>& dropped, const Tracks& before, const Tracks& after) {
  for (DroppedSighting& d : dropped) {
    const Station& was = before.stations[d.sighting.station];
    int best = -1;
    for (int s = 0; s < after.station_count(); ++s)
      if (after.stations[s].device == was.device && (best < 0 || after.stations[s].name == was.name))
        best = s;
    d.sighting.station = std::max(best, 0);
  }
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
    c.tracks = pinhole_view(tracks, c.dropped);
    c.merged = merge_stations(c.tracks);
    name_anew(c.dropped, tracks, c.tracks);
    Tracks counted = c.tracks;
    counted.devices = tracks.devices;
    c.count = count_numbers(counted);
    if (const std::string shortage = shortage_in_words(counted, c.count); !shortage.empty()) {
      refuse(c, fmt::format("{}; {}", fmt::join(c.merged, "; "), shortage));
      return c;
    }
    std::vector<SolvedPair> pairs = solve_pairs(c.tracks);
    if (pairs.empty()) throw Refusal("too few points: no two stations share 8");
    auto dropped = drop_pair_outliers(c.tracks, pairs);
    std::move(dropped.begin(), dropped.end(), std::back_inserter(c.dropped));
    solve_and_judge(c, pairs, options, tracks.devices, tracks.sightings.size());
  } catch (const Refusal& refusal) {
    refuse(c, refusal.what());
  }
  return c;
}

}  // namespace laterna
