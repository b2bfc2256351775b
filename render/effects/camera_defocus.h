// A camera out of focus, as a thin lens. Stage: rays.
//
// Each of a pixel's rays starts at a point a of the aperture's disc, in the plane z = 0 of the camera, and
// passes where the ray (d, 1) through the lens's centre meets depth z_f:
//
//   x(z) = (a, 0) + z·(d - a/z_f, 1),
//
// so that a point at depth z blurs to a disc of diameter √(fx·fy)·A·|1/z_f - 1/z| px. Traced rays, so that
// what stands in front hides what a lens would see past it. Points are stratified and area-uniform.
// Neglected: the slope of brightness over the aperture (as for a pixel at its centre).
#pragma once

#include "render/pixel_samples.h"
#include "sim/effect_parameters.h"

namespace laterna {

/// Where sample `sample` of a pixel's rays starts, x and y in the camera's frame in metres; (0, 0) for a
/// single ray. The camera needs aperture_m.
glm::vec2 lens_point_m(const Optics& optics, const PixelSamples& samples, std::uint32_t camera,
                       const glm::ivec2& pixel, int sample);

}  // namespace laterna
