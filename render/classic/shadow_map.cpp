#include "render/classic/shadow_map.h"

#include "render/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace laterna {

namespace {

/// The same view over another number of pixels: u + 0.5 grows in proportion.
Intrinsics over_pixels(const Intrinsics& k, glm::ivec2 size) {
  const glm::dvec2 scale = glm::dvec2(size) / glm::dvec2(k.size);
  return {size, k.fx * scale.x, k.fy * scale.y, (k.cx + 0.5) * scale.x - 0.5, (k.cy + 0.5) * scale.y - 0.5};
}

}  // namespace

ShadowMap make_shadow_map(const RayScene& rays, const Scene& scene, const Projector& projector, int texels) {
  Camera seat;
  seat.device = projector.device;
  seat.device.lens = {};
  seat.device.intrinsics = over_pixels(projector.device.intrinsics, {texels, texels});
  const SurfaceMap surface = trace_surface(rays, scene, seat);
  ShadowMap map(texels, texels, std::numeric_limits<double>::infinity());
  for (std::size_t p = 0; p < map.values.size(); ++p)
    if (surface.hit(p)) map.values[p] = surface.depth_m.values[p];
  return map;
}

bool lit_by(const ShadowMap& map, const glm::dvec2& pixel, glm::ivec2 size, double depth_m, double bias_m) {
  const auto texel = [](double at, int pixels, int texels) {
    return std::clamp(int(std::floor((at + 0.5) / pixels * texels)), 0, texels - 1);
  };
  return map(texel(pixel.x, size.x, map.width), texel(pixel.y, size.y, map.height)) >= depth_m - bias_m;
}

}  // namespace laterna
