// A homography explains a pair: is the scene a plane, or did the devices stand in one place?
#pragma once

#include "calib/selfcal/pair.h"

#include <optional>

namespace laterna {

/// rms, in sigmas (a's noise carried over to b's pixels) and per coordinate, of the best x_b =
/// K_b·R·K_a⁻¹·x_a over rotations and the free intrinsics of both devices. None where these are five or more,
/// with which any homography can be so.
std::optional<double> turned_scale(const StationPair& pair, const TrackDevice& a, const TrackDevice& b,
                                   const glm::dmat3& homography);

}  // namespace laterna
