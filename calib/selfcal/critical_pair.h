// Do the points of a pair lie on a critical surface, on which more than one pair of placements explains them?
#pragma once

#include "calib/selfcal/pair.h"

#include <optional>

namespace laterna {

/// How well another matrix, unlike the fundamental one, fulfils x_bᵀ·M·x_a = 0: rms of Sampson's distance in
/// sigmas under the best M orthogonal to F. Points on a quadric through both centres have such an M, and with
/// it a pencil of fundamental matrices, one or three of them real (Hartley and Zisserman, 22.2); points on a
/// plane have two. None for fewer than 12 points, of which eight numbers fit too much.
std::optional<double> other_matrix_scale(const StationPair& pair, const glm::dmat3& fundamental);

/// It fits as well as the fundamental matrix, within a fifth.
bool on_critical_surface(const StationPair& pair, const PairGeometry& geometry);

}  // namespace laterna
