#include "apps/lab/classics/core_picture.h"

#include "render/effects/apply_effects.h"
#include "render/replay.h"
#include "sim/error.h"

#include <algorithm>

namespace laterna {

CoreView::CoreView(const Scene& scene_to_see)
    : scene(scene_to_see), rays(scene), surface([&] {
        if (scene.cameras.empty() || scene.projectors.empty())
          throw InputError("a classic's scene needs a [[camera]] and a [[projector]]");
        return trace_surface(rays, scene, scene.cameras[0]);
      }()) {
  for (const Projector& projector : scene.projectors)
    lights.push_back(trace_light(rays, scene, surface, projector));
  apply_effects(surface, lights, rays, scene, scene.cameras[0]);
}

PatternStack slide_of(const Scene& scene, int projector) {
  const Projector& source = scene.projectors[std::size_t(projector)];
  if (scene.effects.slide) return make_patterns(scene, source);
  const glm::ivec2 size = source.device.intrinsics.size;
  return {size.x, size.y, 1, std::vector<std::uint8_t>(std::size_t(size.x) * size.y, 255)};
}

Image<float> slide_light(const LightMap& light, const PatternStack& slide, Lookup lookup) {
  Image<float> share(light.width, light.height);
  const auto texel = [&](int x, int y) { return double(slide.light_of_value[*slide.texel(x, y)]); };
  for (std::size_t p = 0; p < share.values.size(); ++p) {
    if (!light.lit(p)) continue;
    const double u = light.u_px.values[p], v = light.v_px.values[p];
    if (lookup == Lookup::nearest) {
      share.values[p] = float(texel(nearest_texel(u, slide.width), nearest_texel(v, slide.height)));
      continue;
    }
    const LinearTaps x = linear_taps(u, slide.width), y = linear_taps(v, slide.height);
    const auto row = [&](int j) { return glm::mix(texel(x.first, j), texel(x.second, j), x.share); };
    share.values[p] = float(glm::mix(row(y.first), row(y.second), y.share));
  }
  return share;
}

Image<float> core_picture(const CoreView& view) {
  const Scene& scene = view.scene;
  const glm::ivec2 size(view.surface.width, view.surface.height);
  Image<float> sum(size.x, size.y);
  for (std::size_t k = 0; k < view.lights.size(); ++k) {
    const double ambient_lx = k == 0 ? scene.ambient_lx : 0;
    const ImageRows rows{size,
                         [&](LightRows& r) { direct_rows(view.surface, view.lights[k], {}, ambient_lx, r); }};
    const PatternStack slide = slide_of(scene, int(k));
    const auto played = play_luminance(rows, scene.projectors[k].lookup, Show(slide));
    std::transform(sum.values.begin(), sum.values.end(), played.values.begin(), sum.values.begin(),
                   std::plus<>());
  }
  return sum;
}

}  // namespace laterna
