#include "apps/lab/dataset/sample_maps.h"

#include "calib/decode.h"
#include "render/effects/apply_effects.h"
#include "sim/parallel.h"

#include <array>
#include <cmath>
#include <optional>

namespace laterna {

namespace {

bool tells_places(PatternKind kind) { return kind != PatternKind::slide && kind != PatternKind::pictures; }

}  // namespace

Image<std::uint8_t> both_see_mask(const LightMap& light) {
  Image<std::uint8_t> mask(light.width, light.height);
  for (std::size_t i = 0; i < mask.values.size(); ++i) mask.values[i] = light.lit(i) ? 255 : 0;
  return mask;
}

LargeVector<float> truth_map(const Traced& traced, const View& view) {
  const SurfaceMap& surface = traced.surfaces[view.camera];
  constexpr std::size_t channels = truth_channels.size();
  LargeVector<float> values(std::size_t(surface.width) * surface.height * channels);
  parallel_for(std::size_t(surface.height), [&](std::size_t y) {
    for (std::size_t i = y * surface.width; i < (y + 1) * surface.width; ++i) {
      const glm::dvec3 n = normal_world(surface, traced.rays, i);
      const std::array<double, channels> of_pixel{view.light.u_px.values[i],
                                                  view.light.v_px.values[i],
                                                  surface.depth_m.values[i],
                                                  n.x,
                                                  n.y,
                                                  n.z,
                                                  surface.hit(i) ? double(surface.object.values[i]) : -1.0};
      for (std::size_t c = 0; c < channels; ++c) values[i * channels + c] = float(of_pixel[c]);
    }
  });
  return values;
}

std::vector<float> correspondences(const Scene& scene, const View& view, const CapturedStack& pictures,
                                   int step_px) {
  std::optional<DecodedMap> decoded;
  if (tells_places(scene.patterns.kind))
    decoded = decode(pictures, pattern_sequence(scene, scene.projectors[view.projector]));
  const LightMap& light = view.light;
  std::vector<float> rows;
  for (int y = 0; y < light.height; y += step_px) {
    for (int x = 0; x < light.width; x += step_px) {
      const std::size_t i = std::size_t(y) * light.width + x;
      const bool lit = light.lit(i), valid = decoded && decoded->valid.values[i];
      if (!lit && !valid) continue;
      for (const double value : {double(x), double(y), light.u_px.values[i], light.v_px.values[i],
                                 valid ? decoded->u_px.values[i] : NAN, valid ? decoded->v_px.values[i] : NAN,
                                 valid ? double(decoded->sigma_px.values[i]) : NAN, double(lit)})
        rows.push_back(float(value));
    }
  }
  return rows;
}

}  // namespace laterna
