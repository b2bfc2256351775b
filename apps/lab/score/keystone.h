// Whether a result is what a calibrator makes of a projector whose keystone is on.
#pragma once

#include "apps/lab/score/probe.h"

#include <optional>
#include <string>

namespace laterna {

/// A keystone that explains a result, and what it leaves.
struct Keystone {
  double remaining_px2 = 0;  ///< of squared_error_px2 over the probe
  std::string words;         ///< which edge is drawn in, and by how much
};

/// A keystone K here draws in one edge of the picture from either end, by shares a and b of it (the scaler's
/// corners, render/effects/scaler.h): two numbers for each of four edges. Codes then say input pixels,
/// h·(true pixel) with h = input_from_panel, and no K without skew holds h. Least squares over a and b of
/// either way to make a result of that, the better one:
///
///   solved   a least-squares solve with the result's lens model ended at it: on surface points, with J of
///            the result's pixels e, JᵀJ·δ = Jᵀ(h(true) - e) moves nothing. What is left is |J·δ|² as a share
///            of the same for h = identity.
///   skew     the free matrix h·K·[R | t] taken apart (RQ), its skew dropped; or likewise with h⁻¹, where
///            someone has confused the two
///
/// None where the result is no rotation, has a lens of more than 14 numbers or another picture size, or fewer
/// than 50 surface points can be used.
std::optional<Keystone> keystone_of(const ScoreRig& result, const Probe& probe);

}  // namespace laterna
