// Diffraction at a round aperture, of projectors and cameras in focus. Stage: rows (projector), rays
// (camera).
//
// The Airy pattern: with x = π·r/(λ/A), r the angle's tangent, the share of light within r is
//
//   E(r) = 1 - J0²(x) - J1²(x),
//
// first zero at r = 1.22·λ/A, that is √(fx·fy)·1.22·λ/A px. Approximation: the density is even between
// circles at quarters of the first dark ring and at dark rings 1 to 5; E is exact on them. What falls beyond
// the fifth (3.9 %, to 5.24·λ/A) is given back in proportion. A projector's entries spread over concentric
// discs, in panel_blur.h; each of a camera's rays is turned by a point of the pattern. Source: Born & Wolf,
// Principles of Optics, 8.5.2.
#pragma once

#include "render/panel_blur.h"
#include "sim/effect_parameters.h"
#include "sim/intrinsics.h"

#include <span>

namespace laterna {

/// A circle about the pattern's centre: its radius over λ/A, and the share of light within it.
struct AiryCircle {
  double radius, share;
};
/// From the centre (0, 0) to the last one, whose share is 1.
std::span<const AiryCircle> airy_circles();

/// √(fx·fy)·λ/A; 0 without aperture_m.
double airy_unit_px(const Optics& optics, const Intrinsics& intrinsics);

/// The pattern as a sum of discs.
std::vector<DiscShare> airy_discs(double unit_px);

/// A point of the pattern, over λ/A, from one of the unit disc: evenly spread points give the pattern.
glm::vec2 airy_point(const glm::vec2& in_unit_disc);

}  // namespace laterna
