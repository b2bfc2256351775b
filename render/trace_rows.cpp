#include "render/trace_rows.h"

#include "render/effects/apply_effects.h"
#include "render/effects/camera_defocus.h"
#include "render/effects/diffraction.h"
#include "render/effects/fill_factor.h"
#include "render/effects/inter_reflection.h"
#include "render/effects/response.h"
#include "render/exposure.h"
#include "sim/error.h"
#include "sim/scene_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace laterna {

namespace {

bool bounces(const Scene& scene) {
  return scene.effects.inter_reflection && scene.inter_reflection.bounces > 0;
}

// The maps of one region, for one sample of each of its pixels: of what the camera sees, or of where one path
// of each has come to; then the surface's albedo is the path's throughput.
struct Maps {
  SurfaceMap surface;
  std::vector<LightMap> lights;  // the playing projector's, then the idle ones'
  std::vector<IdleLight> idle;

  Maps(const PixelRegion& region, const std::vector<IdleProjector>& others)
      : surface(make_surface_map(region)) {
    for (std::size_t i = 0; i <= others.size(); ++i)
      lights.push_back(make_light_map(region.width, region.height));
    for (std::size_t i = 0; i < others.size(); ++i) idle.push_back({&lights[i + 1], others[i].share});
  }
};

// Where one sample of each of a region's pixels starts and aims.
struct SampleRays {
  std::vector<glm::vec2> offsets_px, lens_m;
};

// What blurs the projector's picture; none where each entry is a point of it.
std::optional<PanelBlur> panel_blur(const Scene& scene, const Projector& projector) {
  const Effects& on = scene.effects;
  const Optics& optics = projector.effects.optics;
  const Intrinsics& k = projector.device.intrinsics;
  const bool defocus = on.projector_defocus && optics.aperture_m && optics.focus_m;
  const bool diffraction = on.diffraction && optics.aperture_m;
  const double side_px = active_side_px(on, optics);
  if (!defocus && !diffraction && side_px == 1) return {};
  PanelBlur blur{k.size, projector.border == Border::clamp || !on.border, side_px};
  if (diffraction) blur.discs = airy_discs(airy_unit_px(optics, k));
  return blur;
}

bool defocuses(const Scene& scene, const Camera& camera) {
  return scene.effects.camera_defocus && camera.optics.aperture_m && camera.optics.focus_m;
}

bool diffracts(const Scene& scene, const Camera& camera) {
  return scene.effects.diffraction && camera.optics.aperture_m;
}

// Traces a region, one sample of each pixel at a time.
class Tracer {
 public:
  Tracer(const RayScene& rays, const Scene& scene, int camera, const CameraRays& directions, int projector,
         const PixelSamples& samples)
      : rays_(rays),
        scene_(scene),
        directions_(directions),
        camera_index_(camera),
        camera_(scene.cameras[camera]),
        view_(make_camera_view(rays, scene, camera_)),
        blur_(panel_blur(scene, scene.projectors[projector])),
        idle_(idle_projectors(scene, projector)),
        samples_(samples) {
    Projector playing = scene.projectors[projector];
    if (blur_) playing.border = Border::clamp;  // points beyond the sharp picture's edge get light too
    add_projector(projector, playing);
    for (const IdleProjector& i : idle_) add_projector(i.projector, scene.projectors[i.projector]);
  }

  void operator()(LightRows& rows) const {
    if (samples_.count == 1 && !bounces(scene_))
      trace_centres(rows);
    else
      trace_samples(rows);
    if (blur_) spread_over_panel(rows, *blur_);
  }

 private:
  void add_projector(int index, const Projector& projector) {
    projectors_.push_back(&scene_.projectors[index]);
    views_.push_back(make_projector_view(rays_, scene_, projector));
  }

  void trace_centres(LightRows& rows) const {
    Maps maps(rows.region, idle_);
    see(maps, {});
    direct_rows(maps.surface, maps.lights[0], maps.idle, scene_.ambient_lx, rows);
  }

  void trace_samples(LightRows& rows) const {
    Maps maps(rows.region, idle_);
    RowBuilder builder(rows.region.size());
    SampleRays places;
    rows.ambient_cd_per_m2.assign(rows.region.size(), 0);
    const double share = 1.0 / samples_.count;
    for (int sample = 0; sample < samples_.count; ++sample) {
      if (samples_.count > 1) place(rows.region, sample, places);
      see(maps, places);
      collect(maps, share, scene_.ambient_lx, rows, builder);
      if (bounces(scene_)) reflect(maps, sample, share, rows, builder);
    }
    builder.finish(rows);
  }

  // What the camera sees, and the projectors' light on it.
  void see(Maps& maps, const SampleRays& places) const {
    SurfaceMap& surface = maps.surface;
    const glm::vec2* offsets_px = places.offsets_px.empty() ? nullptr : places.offsets_px.data();
    const LensPoints lens{camera_.optics.focus_m.value_or(0), places.lens_m.data()};
    for (int tile_row = 0; tile_row * tile_edge < surface.height; ++tile_row) {
      trace_surface_tiles(rays_, view_, directions_, tile_row, surface, offsets_px,
                          places.lens_m.empty() ? nullptr : &lens);
    }
    light(maps);
    apply_surface_effects(surface, scene_);
    for (std::size_t i = 0; i < views_.size(); ++i)
      apply_light_effects(maps.lights[i], surface, rays_, scene_, *projectors_[i], camera_);
    apply_camera_effects(surface, rays_, scene_, camera_);
  }

  void light(Maps& maps) const {
    for (std::size_t i = 0; i < views_.size(); ++i)
      for (int tile_row = 0; tile_row * tile_edge < maps.surface.height; ++tile_row)
        trace_light_tiles(rays_, views_[i], maps.surface, tile_row, maps.lights[i]);
  }

  // Adds what comes to the points that the camera sees by way of others. Overwrites the maps.
  void reflect(Maps& maps, int sample, double share, LightRows& rows, RowBuilder& builder) const {
    const auto [bounces, paths] = scene_.inter_reflection;
    const SurfaceMap seen = maps.surface;
    for (int path = 0; path < paths; ++path) {
      maps.surface = seen;
      for (int bounce = 0; bounce < bounces; ++bounce) {
        follow_paths(rays_, scene_,
                     {samples_.seed, std::uint32_t(camera_index_), sample, path, paths, bounce},
                     maps.surface);
        light(maps);
        for (std::size_t i = 0; i < views_.size(); ++i)
          apply_light_effects(maps.lights[i], maps.surface, rays_, scene_, *projectors_[i]);
        collect(maps, share / paths, 0, rows, builder);
      }
    }
  }

  void place(const PixelRegion& region, int sample, SampleRays& places) const {
    const auto id = std::uint32_t(camera_index_);
    const bool on_lens = defocuses(scene_, camera_), turned = diffracts(scene_, camera_);
    const double airy_px = airy_unit_px(camera_.optics, camera_.device.intrinsics);
    places.offsets_px.resize(region.size());
    if (on_lens) places.lens_m.resize(region.size());
    for (std::size_t p = 0; p < region.size(); ++p) {
      const glm::ivec2 pixel(region.x + int(p) % region.width, region.y + int(p) / region.width);
      places.offsets_px[p] = sample_offset_px(samples_, id, pixel, sample);
      if (turned)
        places.offsets_px[p] +=
            float(airy_px) *
            airy_point(disc_from_square(stratified_square(samples_, id, pixel, sample, SampleUse::airy)));
      if (on_lens) places.lens_m[p] = lens_point_m(camera_.optics, samples_, id, pixel, sample);
    }
  }

  void collect(const Maps& maps, double share, double ambient_lx, LightRows& rows,
               RowBuilder& builder) const {
    const LightMap& light = maps.lights[0];
    for (std::size_t p = 0; p < rows.region.size(); ++p) {
      rows.ambient_cd_per_m2[p] +=
          share * constant_luminance_cd_per_m2(maps.surface, maps.idle, ambient_lx, p);
      if (!light.lit(p)) continue;
      const double albedo = maps.surface.albedo.values[p];
      builder.add(p, {light.u_px.values[p], light.v_px.values[p],
                      share * luminance_cd_per_m2(albedo, light.white_lx.values[p], 0), light.footprint(p)});
    }
  }

  const RayScene& rays_;
  const Scene& scene_;
  const CameraRays& directions_;
  int camera_index_;
  const Camera& camera_;
  CameraView view_;
  std::optional<PanelBlur> blur_;
  std::vector<IdleProjector> idle_;
  std::vector<const Projector*> projectors_;  // the playing one, then the idle ones
  std::vector<ProjectorView> views_;
  PixelSamples samples_;
};

}  // namespace

RowSource trace_rows(const RayScene& rays, const Scene& scene, int camera, const CameraRays& directions,
                     int projector, const PixelSamples& samples) {
  if (samples.count < 1 || samples.count > most_samples_per_pixel)
    throw InputError(fmt::format("samples per pixel: {} was found, expected a whole number from 1 to {}",
                                 samples.count, most_samples_per_pixel));
  const auto tracer = std::make_shared<Tracer>(rays, scene, camera, directions, projector, samples);
  return [tracer](LightRows& rows) { (*tracer)(rows); };
}

PixelSamples samples_of(const Scene& scene, int camera, std::uint64_t seed) {
  const Camera& c = scene.cameras[camera];
  const bool antialiasing = scene.effects.antialiasing;
  const bool spread = antialiasing || defocuses(scene, c) || diffracts(scene, c);
  return {spread ? c.samples_per_pixel : 1, seed,
          antialiasing || !spread ? active_side_px(scene.effects, c.optics) : 0};
}

std::vector<IdleProjector> idle_projectors(const Scene& scene, int projector) {
  std::vector<IdleProjector> idle;
  for (int i = 0; i < int(scene.projectors.size()); ++i) {
    const double share = black_light(scene.effects, scene.projectors[i].effects);
    if (i != projector && share > 0) idle.push_back({i, share});
  }
  return idle;
}

bool rows_are_direct(const Scene& scene, int camera) {
  const auto blurs = [&](const Projector& projector) { return panel_blur(scene, projector).has_value(); };
  return samples_of(scene, camera, 0).count == 1 && !bounces(scene) &&
         std::none_of(scene.projectors.begin(), scene.projectors.end(), blurs);
}

glm::ivec2 region_px_of(const Scene& scene, const PixelSamples& samples) {
  // 2¹⁸ entries: 8 MiB, in memory twice while they are put in order.
  constexpr std::int64_t most_entries = 1 << 18, tile_pixels = tile_edge * tile_edge;
  const InterReflection& r = scene.inter_reflection;
  const std::int64_t per_path = bounces(scene) ? std::int64_t(r.paths) * r.bounces : 0;
  const bool blurs = scene.effects.projector_defocus || scene.effects.diffraction;
  const std::int64_t per_entry = blurs ? most_cells_across * most_cells_across : 1;
  const std::int64_t tiles = most_entries / (samples.count * (1 + per_path) * per_entry * tile_pixels);
  return {tile_edge * std::clamp<int>(int(tiles), 1, ImageRows{}.region_px.x / tile_edge), tile_edge};
}

}  // namespace laterna
