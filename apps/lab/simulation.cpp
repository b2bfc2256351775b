#include "apps/lab/simulation.h"

#include "render/automatic_exposure.h"
#include "render/effects/apply_effects.h"
#include "render/effects/camera_show.h"
#include "render/effects/colour.h"
#include "render/effects/displacement.h"
#include "render/effects/rig_move.h"
#include "render/exposure.h"
#include "render/trace_rows.h"
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

const View& Traced::view(int camera, int projector) const {
  return *std::find_if(views.begin(), views.end(),
                       [&](const View& v) { return v.camera == camera && v.projector == projector; });
}

namespace {

// Rows of direct light at pixel centres, with the black of the other projectors.
ImageRows direct_view_rows(const Scene& scene, const Traced& traced, const View& view) {
  const SurfaceMap& surface = traced.surfaces[view.camera];
  std::vector<IdleLight> idle;
  for (const IdleProjector& i : idle_projectors(scene, view.projector))
    idle.push_back({&traced.view(view.camera, i.projector).light, i.share});
  return {{surface.width, surface.height}, [&scene, &surface, &view, idle](LightRows& rows) {
            direct_rows(surface, view.light, idle, scene.ambient_lx, rows);
          }};
}

}  // namespace

SceneRays make_rig(const Scene& scene, StageTimes& times) {
  if (scene.projectors.empty()) throw InputError("the scene has no [[projector]], expected at least one");
  if (scene.cameras.empty()) throw InputError("the scene has no [[camera]], expected at least one");
  std::optional<Scene> moved;
  times.measure("build", [&] { displaced(scene, moved); });
  SceneRays rig{times.measure("build", [&] { return RayScene(moved ? *moved : scene); }), {}, {}};
  if (moved) rig.displaced = std::make_unique<const Scene>(std::move(*moved));
  times.measure("surface", [&] {
    for (const Camera& camera : scene.cameras) rig.directions.emplace_back(camera.device);
  });
  return rig;
}

StripTracer::StripTracer(const Scene& scene, const SceneRays& rig, int camera, int projector)
    : scene_(rig.as_seen(scene)),
      rig_(rig),
      camera_(camera),
      projector_(projector),
      eye_(make_camera_view(rig.rays, scene_, scene_.cameras[camera])),
      source_(make_projector_view(rig.rays, scene_, scene_.projectors[projector])) {}

int StripTracer::count() const { return (rig_.directions[camera_].height() + tile_edge - 1) / tile_edge; }

Strip StripTracer::trace(int tile_row) const {
  const CameraRays& directions = rig_.directions[camera_];
  const int y = tile_row * tile_edge, height = std::min(tile_edge, directions.height() - y);
  Strip strip{make_surface_map({0, y, directions.width(), height}),
              make_light_map(directions.width(), height)};
  trace_surface_tiles(rig_.rays, eye_, directions, 0, strip.surface);
  trace_light_tiles(rig_.rays, source_, strip.surface, 0, strip.light);
  apply_light_effects(strip.light, strip.surface, rig_.rays, scene_, scene_.projectors[projector_],
                      scene_.cameras[camera_]);
  return strip;
}

ImageRows rig_rows(const Scene& scene, const SceneRays& rig, int camera, int projector,
                   const PixelSamples& samples) {
  const CameraRays& directions = rig.directions[camera];
  return {{directions.width(), directions.height()},
          trace_rows(rig.rays, rig.as_seen(scene), camera, directions, projector, samples),
          region_px_of(scene, samples)};
}

namespace {

ImageRows in_colour(ImageRows rows, const Scene& scene, int camera, int projector) {
  rows.rows = apply_colour(std::move(rows.rows), scene, camera, projector, false);
  return rows;
}

// Rows by which a view is exposed: those of pixel centres, or, where surfaces light each other, which costs
// many rays, those of every sixteenth tile along diagonals.
ImageRows exposure_rows(const Scene& scene, const SceneRays& rig, int camera, int projector) {
  ImageRows all = in_colour(rig_rows(scene, rig, camera, projector, {}), scene, camera, projector);
  if (!scene.effects.inter_reflection) return all;
  const RowSource some = [rows = all.rows](LightRows& out) {
    const PixelRegion& r = out.region;
    if ((r.x + 3 * r.y) / tile_edge % 16 == 0) return rows(out);
    out.begin.assign(r.size() + 1, 0);
    out.entries.clear();
    out.ambient_cd_per_m2.assign(r.size(), 0);
  };
  return {all.size, some, glm::ivec2(tile_edge)};
}

}  // namespace

double saturation_cd_per_m2(const Scene& scene, const SceneRays& rig, int camera, int projector,
                            StageTimes& times) {
  const std::optional<double> fixed = fixed_saturation_cd_per_m2(scene.cameras[camera].sensor);
  if (fixed) return *fixed;
  const ImageRows rows = exposure_rows(scene, rig, camera, projector);
  return times.measure("exposure", [&] { return automatic_saturation_cd_per_m2({&rows, 1}); });
}

Traced trace_maps(const Scene& given, StageTimes& times, const Progress& progress) {
  Traced traced{make_rig(given, times), {}, {}, {}};
  const Scene& scene = traced.as_seen(given);
  const RayScene& rays = traced.rays;
  for (int c = 0; c < int(scene.cameras.size()); ++c) {
    const Camera& camera = scene.cameras[c];
    if (progress) {
      progress(fmt::format("tracing {} × {} rays of \"{}\" and the light of {} projector(s)",
                           camera.device.intrinsics.size.x, camera.device.intrinsics.size.y,
                           camera.device.name, scene.projectors.size()));
    }
    traced.surfaces.push_back(
        times.measure("surface", [&] { return trace_surface(rays, scene, camera, traced.directions[c]); }));
    traced.points_world.push_back(
        times.measure("surface", [&] { return points_world(traced.surfaces[c], scene); }));
    std::vector<LightMap> lights;
    for (const Projector& projector : scene.projectors) {
      lights.push_back(
          times.measure("light", [&] { return trace_light(rays, scene, traced.surfaces[c], projector); }));
    }
    times.measure("effects", [&] { apply_effects(traced.surfaces[c], lights, rays, scene, camera); });
    for (int p = 0; p < int(lights.size()); ++p) traced.views.push_back({c, p, std::move(lights[p]), 0});
  }
  return traced;
}

void expose_views(const Scene& given, Traced& traced, StageTimes& times) {
  const Scene& scene = traced.as_seen(given);
  for (View& view : traced.views) {
    const std::optional<double> fixed = fixed_saturation_cd_per_m2(scene.cameras[view.camera].sensor);
    view.saturation_cd_per_m2 = fixed ? *fixed : times.measure("exposure", [&] {
      const ImageRows rows =
          rows_are_direct(scene, view.camera)
              ? in_colour(direct_view_rows(scene, traced, view), scene, view.camera, view.projector)
              : exposure_rows(scene, traced, view.camera, view.projector);
      return automatic_saturation_cd_per_m2({&rows, 1});
    });
  }
}

Traced trace(const Scene& scene, StageTimes& times, const Progress& progress) {
  Traced traced = trace_maps(scene, times, progress);
  expose_views(scene, traced, times);
  return traced;
}

ImageRows view_rows(const Scene& scene, const Traced& traced, const View& view, std::uint64_t seed) {
  if (rows_are_direct(scene, view.camera)) return direct_view_rows(scene, traced, view);
  return rig_rows(scene, traced, view.camera, view.projector, samples_of(scene, view.camera, seed));
}

namespace {

// The same rows; adds the entries that they had.
ImageRows counted(const ImageRows& image, std::atomic<std::uint64_t>& entries) {
  return {image.size,
          [&entries, inner = image.rows](LightRows& rows) {
            inner(rows);
            entries += rows.entries.size();
          },
          image.region_px};
}

}  // namespace

CapturedStack capture_rows(const Scene& scene, int camera, int projector, const ImageRows& rows,
                           double saturation_cd_per_m2, std::uint64_t seed, StageTimes& times,
                           std::atomic<std::uint64_t>* entries) {
  const Projector& source = scene.projectors[projector];
  const Exposure exposure = make_exposure(scene.cameras[camera].sensor, saturation_cd_per_m2,
                                          {seed, std::uint32_t(camera), std::uint32_t(projector)});
  CameraShow played =
      times.measure("patterns", [&] { return make_camera_show(scene, camera, projector, rows); });
  if (entries) played.rows = counted(played.rows, *entries);
  CapturedStack stack = times.measure(
      "capture", [&] { return play_stack(played.rows, source.lookup, played.show(), exposure); });
  if (!moves(scene, camera, projector)) return stack;
  const Scene moved = after_move(scene);
  const SceneRays rig = make_rig(moved, times);
  const ImageRows moved_rows = rig_rows(moved, rig, camera, projector, samples_of(moved, camera, seed));
  splice(stack, capture_rows(moved, camera, projector, moved_rows, saturation_cd_per_m2, seed, times),
         scene.timing.moved.from_picture);
  return stack;
}

CapturedStack capture_view(const Scene& scene, const Traced& traced, const View& view, std::uint64_t seed,
                           StageTimes& times) {
  return capture_rows(scene, view.camera, view.projector, view_rows(scene, traced, view, seed),
                      view.saturation_cd_per_m2, seed, times);
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
