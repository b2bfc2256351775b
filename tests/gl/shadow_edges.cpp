#include "tests/gl/shadow_edges.h"

#include <cmath>

namespace laterna::gl {

namespace {

// Lit, or dark for want of light from the projector's side: in shadow, or turned away.
bool counts(const LightMap& light, std::size_t p) {
  const Unlit why = Unlit(light.why.values[p]);
  return why == Unlit::lit || why == Unlit::shadow || why == Unlit::back_face;
}

glm::ivec2 texel_of(const LightMap& light, std::size_t p, glm::ivec2 size) {
  return {nearest_texel(light.u_px.values[p], size.x), nearest_texel(light.v_px.values[p], size.y)};
}

// Spreads 1s along rows by up to `reach` and turns the picture: twice is a box.
Image<std::uint8_t> spread_and_turned(const Image<std::uint8_t>& marks, int reach) {
  Image<std::uint8_t> turned(marks.height, marks.width);
  for (int y = 0; y < marks.height; ++y) {
    for (int x = 0; x < marks.width; ++x) {
      if (!marks(x, y)) continue;
      for (int i = std::max(x - reach, 0); i <= std::min(x + reach, marks.width - 1); ++i) turned(y, i) = 1;
    }
  }
  return turned;
}

}  // namespace

Image<std::uint8_t> near_shadow_edges(const Scene& scene, const LightMap& light, const glm::dvec2& reach_px) {
  const glm::ivec2 size = scene.projectors[0].device.intrinsics.size, reach(glm::ceil(reach_px));
  Image<std::uint8_t> marks(size.x, size.y), near(light.width, light.height);
  for (int y = 0; y < light.height; ++y) {
    for (int x = 0; x < light.width; ++x) {
      const std::size_t p = light.why.index(x, y);
      for (const glm::ivec2 beside : {glm::ivec2(x + 1, y), glm::ivec2(x, y + 1)}) {
        if (beside.x == light.width || beside.y == light.height) continue;
        const std::size_t q = light.why.index(beside.x, beside.y);
        if (!counts(light, p) || !counts(light, q) || light.lit(p) == light.lit(q)) continue;
        for (const std::size_t of : {p, q}) {
          const glm::ivec2 texel = texel_of(light, of, size);
          marks(texel.x, texel.y) = 1;
        }
      }
    }
  }
  const auto box = spread_and_turned(spread_and_turned(marks, reach.x), reach.y);
  for (std::size_t p = 0; p < near.values.size(); ++p) {
    if (!counts(light, p)) continue;
    const glm::ivec2 texel = texel_of(light, p, size);
    near.values[p] = box(texel.x, texel.y);
  }
  return near;
}

}  // namespace laterna::gl
