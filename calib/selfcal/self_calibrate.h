// Correspondences alone to devices and placements, up to scale, with covariance and an honest verdict.
#pragma once

#include "calib/selfcal/count.h"
#include "calib/selfcal/pair_outliers.h"
#include "calib/selfcal/track_covariance.h"
#include "calib/selfcal/track_ladder.h"
#include "calib/selfcal/track_lens.h"
#include "calib/solve.h"

#include <optional>
#include <string>
#include <vector>

namespace laterna {

struct SelfCalibrationOptions {
  std::optional<KnownLength> length;  ///< else the first unit baseline is 1
  double tolerance_px = 1;            ///< a predicted_px of a station above it is `weak`
  double weak_focal = 0.02;    ///< a focal length, centre or lens known worse than this share of f is `weak`,
  double refused_focal = 0.2;  ///< and worse than this `refused`: the linear error law is void there
};

struct StationReport {
  std::size_t sightings = 0;
  double rms_px = 0;        ///< sqrt(mean(du² + dv²)) of its sightings
  double predicted_px = 0;  ///< track_covariance.h
};

struct SelfCalibration {
  Status status = Status::refused;
  std::string reason;  ///< one sentence, or several joined by "; "; empty where ok
  NumberCount count;
  std::vector<std::string> merged;  ///< stations that stand in one place
  std::vector<DroppedSighting> dropped;

  Tracks tracks;                             ///< what was fitted, with the sigmas in use
  TrackRig rig;                              ///< meaningless where refused before it was solved
  std::vector<UnitBaseline> units;           ///< of length 1 where there is no known length
  bool metric = false;                       ///< lengths are metres, by the known length
  std::vector<std::string> parameter_names;  ///< track_rig.h: column_names()
  std::vector<double> covariance;            ///< row-major, in their order; times residual_scale² where > 1
  std::vector<double> sigma;
  double fit_rms_px = 0;      ///< sqrt(mean(du² + dv²)) over all sightings
  double residual_scale = 0;  ///< sqrt(Σ r²/degrees of freedom): 1 where the sigmas explain the residuals
  double focal_sigma = 0;     ///< largest sigma of a focal length or centre, as a share of f
  double lens_sigma = 0;      ///< of a lens parameter, as a share of f at the image's corner
  TrackLadder ladder;         ///< where a device's lens climbs
  TrackLensLeftOut lens_left_out;
  double smallest_gap = 0, weakest_sigma = 0;
  std::string weakest_direction;
  std::vector<StationReport> stations;
  int iterations = 0;
  std::string termination;  ///< Ceres's own words
};

/// Maximum likelihood of intrinsics, placements and points (adjust_tracks.h) from starts of its own
/// (reconstruct.h), after the count (count.h), without outliers, which are named. What is not determined by
/// pixels is refused with the reason:
/// fewer numbers given than asked for, or too few points; stations that share no points; stations that turn
/// out to stand in one place (moving the scene adds nothing); a homography that explains the strongest pair
/// (a plane, or devices without a baseline); both focal lengths of one pair whose optical axes meet; any
/// other Jacobian that leaves a focal length, centre or lens open by refused_focal (points on a critical
/// surface, turns about one axis, ...); two different solutions that explain the points; no convergence.
/// Weak: a focal length or centre known worse than weak_focal, predicted pixels worse than the tolerance,
/// residuals over twice the measured sigmas, residuals that follow a lens which was not asked for
/// (track_lens.h), more than 30 % outliers. Lenses: known ones are undone for the start and kept in the
/// adjustment; of those that are asked for the start is a pinhole, then their parameters are adjusted with
/// the rest; those that climb get terms while points that were left out are forecast better (track_ladder.h).
/// Throws InputError for tracks that validate() refuses, or a length between points that are not there.
SelfCalibration self_calibrate(const Tracks& tracks, const SelfCalibrationOptions& options = {});

}  // namespace laterna
