#include "render/trace_rows.h"

#include "render/effects/apply_effects.h"
#include "render/effects/response.h"
#include "render/exposure.h"
#include "sim/error.h"
#include "sim/scene_limits.h"

#include <fmt/format.h>

#include <memory>

namespace laterna {

namespace {

// The maps of one region, for one sample of each of its pixels.
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

// Traces a region, one sample of each pixel at a time.
class Tracer {
 public:
  Tracer(const RayScene& rays, const Scene& scene, int camera, const CameraRays& directions, int projector,
         const PixelSamples& samples)
      : rays_(rays),
        scene_(scene),
        directions_(directions),
        camera_index_(camera),
        camera_(make_camera_view(rays, scene, scene.cameras[camera])),
        idle_(idle_projectors(scene, projector)),
        samples_(samples) {
    add_projector(projector);
    for (const IdleProjector& i : idle_) add_projector(i.projector);
  }

  void operator()(LightRows& rows) const {
    Maps maps(rows.region, idle_);
    if (samples_.count == 1) {
      trace(maps, nullptr);
      direct_rows(maps.surface, maps.lights[0], maps.idle, scene_.ambient_lx, rows);
      return;
    }
    RowBuilder builder(rows.region.size());
    std::vector<glm::vec2> offsets(rows.region.size());
    rows.ambient_cd_per_m2.assign(rows.region.size(), 0);
    for (int sample = 0; sample < samples_.count; ++sample) {
      jitter(rows.region, sample, offsets);
      trace(maps, offsets.data());
      collect(maps, rows, builder);
    }
    builder.finish(rows);
  }

 private:
  void add_projector(int index) {
    projectors_.push_back(&scene_.projectors[index]);
    views_.push_back(make_projector_view(rays_, scene_, scene_.projectors[index]));
  }

  void trace(Maps& maps, const glm::vec2* offsets) const {
    SurfaceMap& surface = maps.surface;
    for (int tile_row = 0; tile_row * tile_edge < surface.height; ++tile_row) {
      trace_surface_tiles(rays_, camera_, directions_, tile_row, surface, offsets);
      for (std::size_t i = 0; i < views_.size(); ++i)
        trace_light_tiles(rays_, views_[i], surface, tile_row, maps.lights[i]);
    }
    const Camera& camera = scene_.cameras[camera_index_];
    apply_surface_effects(surface, scene_);
    for (std::size_t i = 0; i < views_.size(); ++i)
      apply_light_effects(maps.lights[i], surface, rays_, scene_, *projectors_[i], camera);
    apply_camera_effects(surface, rays_, scene_, camera);
  }

  void jitter(const PixelRegion& region, int sample, std::vector<glm::vec2>& offsets) const {
    for (std::size_t p = 0; p < offsets.size(); ++p) {
      const glm::ivec2 pixel(region.x + int(p) % region.width, region.y + int(p) / region.width);
      offsets[p] = sample_offset_px(samples_, std::uint32_t(camera_index_), pixel, sample);
    }
  }

  void collect(const Maps& maps, LightRows& rows, RowBuilder& builder) const {
    const double share = 1.0 / samples_.count;
    const LightMap& light = maps.lights[0];
    for (std::size_t p = 0; p < rows.region.size(); ++p) {
      rows.ambient_cd_per_m2[p] +=
          share * constant_luminance_cd_per_m2(maps.surface, maps.idle, scene_.ambient_lx, p);
      if (!light.lit(p)) continue;
      const double albedo = maps.surface.albedo.values[p];
      builder.add(p, {light.u_px.values[p], light.v_px.values[p],
                      share * luminance_cd_per_m2(albedo, light.white_lx.values[p], 0)});
    }
  }

  const RayScene& rays_;
  const Scene& scene_;
  const CameraRays& directions_;
  int camera_index_;
  CameraView camera_;
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
  return {scene.effects.antialiasing ? scene.cameras[camera].samples_per_pixel : 1, seed};
}

std::vector<IdleProjector> idle_projectors(const Scene& scene, int projector) {
  std::vector<IdleProjector> idle;
  for (int i = 0; i < int(scene.projectors.size()); ++i) {
    const double share = black_light(scene.effects, scene.projectors[i].effects);
    if (i != projector && share > 0) idle.push_back({i, share});
  }
  return idle;
}

bool rows_are_direct(const Scene& scene, int camera) { return samples_of(scene, camera, 0).count == 1; }

}  // namespace laterna
