// The joint adjustment: intrinsics, placements and points in one bundle, by Ceres.
#pragma once

#include "calib/robust_loss.h"
#include "calib/selfcal/track_rig.h"

#include <optional>
#include <string>
#include <vector>

namespace laterna {

struct TrackAdjustment {
  TrackRig rig;
  double loss = 0;  ///< Σ ρ(s), s = (du² + dv²)/σ² of each sighting of a placed point
  bool converged = false;
  int iterations = 0;
  std::string termination;  ///< Ceres's own words
};

/// Minimises ½ Σ ρ(s) over everything free and every placed point (Schur: the points are eliminated), from
/// analytic derivatives (sighting_cost.h), until Ceres finds convergence near rounding. Gauge: station 0
/// stays where it is, and each unit baseline is kept at length 1 by a residual of its own, which the pixels
/// do not resist. Points with fewer than two sightings stand still. None where the start has a sighting
/// behind its station, or something is not finite.
std::optional<TrackAdjustment> adjust_tracks(const Tracks& tracks, const TrackRig& start,
                                             const std::vector<UnitBaseline>& units,
                                             const RobustLoss& loss = {}, int max_iterations = 500,
                                             double function_tolerance = 1e-14);

}  // namespace laterna
