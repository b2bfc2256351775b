// Mistakes whose size must be measured before they are undone: overscan and keystone.
#pragma once

#include "apps/lab/score/probe.h"

#include <optional>
#include <string>
#include <vector>

namespace laterna {

/// A fitted map of the result's pixels onto the true ones, and what it leaves.
struct FittedUndo {
  std::string suspect;
  int parameters = 0;        ///< that were fitted
  double remaining_px2 = 0;  ///< squared_error_px2 after it
  std::string words;         ///< what was found
};

/// Least squares over the points that the result projects to within a diagonal of the truth:
///
///   overscan  u_true = c + s·(u - c) about the picture's middle, s one number for both axes, or one for
///   each.
///             An error of the focal lengths alone looks the same where the centre is in the picture's
///             middle.
///   keystone  an edge drawn in (keystone.h); or any homography of the picture about the same centre that
///             moves all four corners inwards, or all four outwards, by up to half of the picture, some by
///             more than 2 px and none by more than 1 px the other way, and of which zoom and shift explain
///             less than nine tenths. About a fixed centre a homography explains any error of K and R; what
///             else it must do keeps it from explaining a projector that was turned, or chance.
///
/// Nothing is fitted where fewer than 20 points remain.
std::vector<FittedUndo> fitted_undoings(const ScoreRig& result, const Probe& probe);

/// What the better overscan of the two leaves of pixels that a result gives to all points of a probe.
double without_overscan_px2(const std::vector<glm::dvec2>& pixels, const Probe& probe);

}  // namespace laterna
