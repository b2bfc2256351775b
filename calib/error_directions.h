// Which directions of a projector's parameters an error lies along: those that its points tell well, or those
// that they hardly tell.
#pragma once

#include "sim/device.h"

#include <span>
#include <vector>

namespace laterna {

/// The error field's energy along each direction, strongest first. With J the 2n×p Jacobian of the pixels at
/// `device` (tangent order of projection_rows.h), its columns scaled to length 1, and J = U·S·Vᵀ: the i-th
/// number is (uᵢᵀe)²/|e|². What the linear model cannot produce is missing, so the sum is at most 1.
/// Independent noise that a least-squares fit has passed on puts 1/p of the modelled energy into each;
/// parameters that are wrong by chance put nearly all into the first few; a descent that was stopped has
/// taken those away and leaves the last. Points that the device does not project are passed over; all zero
/// where e is.
std::vector<double> error_directions(const Device& device, std::span<const glm::dvec3> points_world,
                                     std::span<const glm::dvec2> errors_px);

}  // namespace laterna
