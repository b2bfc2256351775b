// A spotlight as a texture: its cone's profile, seen through a projector's frustum.
#pragma once

#include "sim/scene.h"

#include <glm/glm.hpp>

#include <cmath>
#include <numbers>

namespace laterna {

/// intensity·cosⁿθ for θ ≤ cutoff, else 0, along a pinhole's ray (x/z, y/z); θ from the optical axis. Source:
/// OpenGL 2.1 specification, 2.14.1.
inline double cone_intensity(const Spotlight& spot, const glm::dvec2& slope) {
  const double cos_theta = 1 / std::sqrt(1 + glm::dot(slope, slope));
  const double least_cos = spot.cutoff_deg ? std::cos(*spot.cutoff_deg * std::numbers::pi / 180) : 0;
  return cos_theta < least_cos ? 0 : spot.intensity * std::pow(cos_theta, spot.exponent);
}

/// (x/z, y/z) of a pinhole's ray through (s, t).
inline glm::dvec2 slope_of(const Intrinsics& k, const glm::dvec2& st) {
  const glm::dvec2 pixel((st.x * k.size.x) - 0.5, ((1 - st.y) * k.size.y) - 0.5);
  return {(pixel.x - k.cx) / k.fx, (pixel.y - k.cy) / k.fy};
}

/// n×n texels over the projector's picture, each with the cone's intensity at its centre.
inline Image<float> intensity_map(const Projector& projector, int n) {
  Image<float> map(n, n);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      map(x, y) = float(cone_intensity(
          projector.effects.spotlight,
          slope_of(projector.device.intrinsics, texture_from_pixel(glm::dvec2(x, y), {n, n}))));
  return map;
}

}  // namespace laterna
