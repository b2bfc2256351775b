// What a self-calibration is worth on points that it never saw.
#pragma once

#include "calib/boards/held_out.h"
#include "calib/selfcal/track_covariance.h"

#include <vector>

namespace laterna {

/// The block of each point, at most 2^levels: points split in two at the median of their longest axis, again
/// and again. -1 for points that are not placed.
std::vector<int> point_blocks(const TrackRig& rig, int levels = 3);

/// Leaves each block of points out in turn: devices and stations from the others by one step of Gauss and
/// Newton from `rig`, their optimum together (as in covariance.h); then each point that was left out is
/// placed by its own pixels under that rig, and rms_px is that of the pixels it leaves, at least 1e-4 px:
/// that is rounding. A fold's `pose` is its block; its `rig` stays empty. Blocks with fewer than 8 sightings
/// are no fold; those without which the rest does not determine the rig have failed.
HeldOut hold_out_points(const Tracks& tracks, const TrackRig& rig, const std::vector<UnitBaseline>& units);

}  // namespace laterna
