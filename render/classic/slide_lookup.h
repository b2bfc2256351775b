// The slide at (s/q, t/q), and which fragments are killed.
#pragma once

#include "render/projective_lookup.h"
#include "sim/image.h"

#include <glm/glm.hpp>

#include <cmath>

namespace laterna {

/// What a texture shows outside [0, 1].
enum class Wrap {
  repeat,         ///< the slide again and again
  clamp_to_edge,  ///< the edge texel, smeared outwards
  border          ///< a border texel of 0: bilinear, the edge fades from half a texel inside to half outside
};

/// The tests that a fragment must pass.
struct FragmentTests {
  bool q = true;   ///< q > 0
  bool st = true;  ///< 0 ≤ s/q < 1 and 0 < t/q ≤ 1: as Border::black
  bool r = true;   ///< 0 ≤ r/q ≤ 1: between the light's near and far plane
};

inline bool survives(const glm::dvec4& strq, const FragmentTests& tests) {
  const glm::dvec3 at = glm::dvec3(strq) / strq.w;
  return (!tests.q || strq.w > 0) && (!tests.st || (at.x >= 0 && at.x < 1 && at.y > 0 && at.y <= 1)) &&
         (!tests.r || (at.z >= 0 && at.z <= 1));
}

/// The texel (x, y) of a picture that goes on beyond its edges.
inline double wrapped_texel(const Image<float>& slide, int x, int y, Wrap wrap) {
  const auto turn = [](int i, int n) { return ((i % n) + n) % n; };
  const bool inside = x >= 0 && y >= 0 && x < slide.width && y < slide.height;
  if (!inside && wrap == Wrap::border) return 0;
  if (!inside && wrap == Wrap::repeat) x = turn(x, slide.width), y = turn(y, slide.height);
  return slide(std::clamp(x, 0, slide.width - 1), std::clamp(y, 0, slide.height - 1));
}

/// The slide at a fragment, by pixel_from_texture. Any q but 0: fixed functions divide by any.
inline double slide_value(const Image<float>& slide, const glm::dvec4& strq, Lookup lookup, Wrap wrap) {
  const glm::dvec2 limit(1e6);  // far outside any slide, still inside an int
  const glm::dvec2 at = glm::clamp(pixel_from_texture(strq, {slide.width, slide.height}), -limit, limit);
  if (lookup == Lookup::nearest)
    return wrapped_texel(slide, int(std::floor(at.x + 0.5)), int(std::floor(at.y + 0.5)), wrap);
  const glm::dvec2 low = glm::floor(at), share = at - low;
  const int x = int(low.x), y = int(low.y);
  const auto row = [&](int j) {
    return glm::mix(wrapped_texel(slide, x, j, wrap), wrapped_texel(slide, x + 1, j, wrap), share.x);
  };
  return glm::mix(row(y), row(y + 1), share.y);
}

}  // namespace laterna
