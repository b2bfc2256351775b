#include "apps/lab/simulation.h"

#include "render/effects/apply_effects.h"
#include "render/exposure.h"
#include "render/replay.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace laterna {

void StageTimes::add(const std::string& name, double seconds) {
  for (Stage& stage : stages) {
    if (stage.name == name) {
      stage.seconds += seconds;
      return;
    }
  }
  stages.push_back({name, seconds});
}

double StageTimes::total() const {
  double sum = 0;
  for (const Stage& stage : stages) sum += stage.seconds;
  return sum;
}

Traced trace(const Scene& scene, StageTimes& times, const Progress& progress) {
  if (scene.projectors.empty()) throw InputError("the scene has no [[projector]], expected at least one");
  if (scene.cameras.empty()) throw InputError("the scene has no [[camera]], expected at least one");
  Traced traced{times.measure("build", [&] { return RayScene(scene); }), {}, {}, {}};
  const RayScene& rays = traced.rays;
  for (int c = 0; c < int(scene.cameras.size()); ++c) {
    const Camera& camera = scene.cameras[c];
    if (progress) {
      progress(fmt::format("tracing {} × {} rays of \"{}\" and the light of {} projector(s)",
                           camera.device.intrinsics.size.x, camera.device.intrinsics.size.y,
                           camera.device.name, scene.projectors.size()));
    }
    traced.surfaces.push_back(times.measure("surface", [&] { return trace_surface(rays, scene, camera); }));
    traced.points_world.push_back(
        times.measure("surface", [&] { return points_world(traced.surfaces[c], scene); }));
    std::vector<LightMap> lights;
    for (const Projector& projector : scene.projectors) {
      lights.push_back(
          times.measure("light", [&] { return trace_light(rays, scene, traced.surfaces[c], projector); }));
    }
    times.measure("effects", [&] { apply_effects(traced.surfaces[c], lights, rays, scene, camera); });
    for (int p = 0; p < int(lights.size()); ++p) {
      const std::optional<double> fixed = fixed_saturation_cd_per_m2(camera.sensor);
      const double saturation =
          fixed ? *fixed
                : automatic_saturation_cd_per_m2(traced.surfaces[c], {&lights[p], 1}, scene.ambient_lx);
      traced.views.push_back({c, p, std::move(lights[p]), saturation});
    }
  }
  return traced;
}

CapturedStack capture_view(const Scene& scene, const Traced& traced, const View& view, std::uint64_t seed,
                           StageTimes& times) {
  const Projector& projector = scene.projectors[view.projector];
  const Exposure exposure = make_exposure(
      scene.cameras[view.camera].sensor, view.saturation_cd_per_m2,
      {seed, static_cast<std::uint32_t>(view.camera), static_cast<std::uint32_t>(view.projector)});
  const auto play = [&](const AnyPatterns& patterns) {
    return times.measure("capture", [&] {
      return capture_stack(traced.surfaces[view.camera], view.light, projector, patterns, scene.ambient_lx,
                           exposure);
    });
  };
  const PatternSequence sequence = pattern_sequence(scene, projector);
  if (projector.lookup == Lookup::nearest && !edits_patterns(scene.effects) && is_binary(sequence)) {
    return play(times.measure("patterns", [&] { return make_binary_pattern_stack(sequence); }));
  }
  return play(times.measure("patterns", [&] { return make_patterns(scene, projector); }));
}

Overlap overlap(const Scene& scene, const Traced& traced, const View& view) {
  constexpr int cell_px = 8;
  const SurfaceMap& surface = traced.surfaces[view.camera];
  const glm::ivec2 size = scene.projectors[view.projector].device.intrinsics.size;
  const glm::ivec2 cells = (size + cell_px - 1) / cell_px;
  std::vector<bool> seen(std::size_t(cells.x) * cells.y, false);
  std::size_t hits = 0, lit = 0;
  for (std::size_t i = 0; i < std::size_t(surface.width) * surface.height; ++i) {
    hits += surface.hit(i);
    if (!view.light.lit(i)) continue;
    ++lit;
    const int x = nearest_texel(view.light.u_px.values[i], size.x) / cell_px;
    const int y = nearest_texel(view.light.v_px.values[i], size.y) / cell_px;
    seen[std::size_t(y) * cells.x + x] = true;
  }
  const auto count = std::count(seen.begin(), seen.end(), true);
  return {hits ? 100.0 * double(lit) / double(hits) : 0, 100.0 * double(count) / double(seen.size())};
}

}  // namespace laterna
