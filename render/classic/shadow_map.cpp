#include "render/classic/shadow_map.h"

#include "render/projective_lookup.h"
#include "render/surface.h"
#include "sim/resample.h"

#include <limits>

namespace laterna {

namespace {

/// The same view over another number of pixels, each way by itself.
Intrinsics over_pixels(const Intrinsics& k, glm::ivec2 size) {
  const glm::dvec2 scale = glm::dvec2(size) / glm::dvec2(k.size);
  return {size, k.fx * scale.x, k.fy * scale.y, resampled_place_px(k.cx, scale.x),
          resampled_place_px(k.cy, scale.y)};
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
  const glm::dvec2 st = texture_from_pixel(pixel, size);
  const glm::dvec2 at = pixel_from_texture({st, 0, 1}, {map.width, map.height});
  return map(nearest_texel(at.x, map.width), nearest_texel(at.y, map.height)) >= depth_m - bias_m;
}

}  // namespace laterna
