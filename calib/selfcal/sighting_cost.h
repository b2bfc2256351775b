// One sighting as Ceres sees it, with analytic derivatives.
#pragma once

#include "calib/selfcal/tracks.h"
#include "sim/lens.h"

#include <ceres/cost_function.h>

#include <memory>

namespace laterna {

/// Pixels are counted in thousands in the intrinsics block, so that all parameters are near 1.
constexpr double track_pixel_scale = 1000;

/// residual = (pixel of the point - measured)/sigma, of the blocks (fx, fy, cx, cy)/track_pixel_scale and
/// lens parameters; rotation vector (radians) and translation of the station; point in the first station's
/// frame. `one_focal`: the first number is fx and fy, the second is passed over. Derivatives are those of
/// project_with_rows() (projection_rows.h), turned from a step in the device's frame into one of the rotation
/// vector by the left Jacobian of SO(3).
std::unique_ptr<ceres::CostFunction> sighting_cost(const LensGradient& lens, const TrackSighting& sighting,
                                                   bool one_focal);

/// J with exp([w + dw]×) = exp([J·dw]×)·exp([w]×) to first order: the left Jacobian of SO(3) (Barfoot, State
/// Estimation for Robotics, 7.1.3).
glm::dmat3 left_jacobian(const glm::dvec3& rotation_vector_rad);

}  // namespace laterna
