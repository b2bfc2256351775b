#include "render/light_rows.h"

#include "render/exposure.h"
#include "sim/error.h"

#include <Random123/philox.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace laterna {

namespace {

using Philox = r123::Philox4x32;

// The cells that a pixel is cut into.
glm::ivec2 strata(int count) {
  int rows = static_cast<int>(std::sqrt(double(count)));
  while (count % rows != 0) --rows;
  return {count / rows, rows};
}

// The numbers of four samples, two times 16 bits each.
Philox::ctr_type draw(std::uint64_t seed, std::uint32_t camera, const glm::ivec2& pixel, int group) {
  const Philox::key_type key{{std::uint32_t(seed), std::uint32_t(seed >> 32)}};
  return Philox()({{std::uint32_t(pixel.x), std::uint32_t(pixel.y), std::uint32_t(group), camera}}, key);
}

glm::vec2 place(std::uint32_t bits, const glm::ivec2& cells, int sample) {
  const glm::vec2 cell(sample % cells.x, sample / cells.x);
  const glm::vec2 inside = (glm::vec2(bits & 0xffffu, bits >> 16) + 0.5f) * 0x1p-16f;
  return (cell + inside) / glm::vec2(cells) - 0.5f;
}

// Traces a region, one sample of each pixel at a time.
class Tracer {
 public:
  Tracer(const RayScene& rays, const Scene& scene, int camera, const CameraRays& directions, int projector,
         const PixelSamples& samples)
      : rays_(rays),
        directions_(directions),
        camera_(make_camera_view(rays, scene, scene.cameras[camera])),
        projector_(make_projector_view(rays, scene, scene.projectors[projector])),
        camera_index_(camera),
        samples_(samples),
        cells_(strata(samples.count)),
        ambient_lx_(scene.ambient_lx) {}

  void operator()(LightRows& rows) const {
    SurfaceMap surface = make_surface_map(rows.region);
    LightMap light = make_light_map(rows.region.width, rows.region.height);
    if (samples_.count == 1) {
      trace(surface, light, nullptr);
      direct_rows(surface, light, ambient_lx_, rows);
      return;
    }
    const std::size_t pixels = rows.region.size();
    std::vector<LightEntry> slots(pixels * samples_.count);
    std::vector<int> used(pixels, 0);
    std::vector<Philox::ctr_type> bits(pixels);
    std::vector<glm::vec2> offsets(pixels);
    rows.ambient_cd_per_m2.assign(pixels, 0);
    for (int sample = 0; sample < samples_.count; ++sample) {
      jitter(rows.region, sample, bits, offsets);
      trace(surface, light, offsets.data());
      collect(surface, light, rows, slots, used);
    }
    pack(slots, used, rows);
  }

 private:
  void trace(SurfaceMap& surface, LightMap& light, const glm::vec2* offsets) const {
    for (int tile_row = 0; tile_row * tile_edge < surface.height; ++tile_row) {
      trace_surface_tiles(rays_, camera_, directions_, tile_row, surface, offsets);
      trace_light_tiles(rays_, projector_, surface, tile_row, light);
    }
  }

  void jitter(const PixelRegion& region, int sample, std::vector<Philox::ctr_type>& bits,
              std::vector<glm::vec2>& offsets) const {
    for (std::size_t p = 0; p < offsets.size(); ++p) {
      const glm::ivec2 pixel(region.x + int(p) % region.width, region.y + int(p) / region.width);
      if (sample % 4 == 0) bits[p] = draw(samples_.seed, std::uint32_t(camera_index_), pixel, sample / 4);
      offsets[p] = place(bits[p][sample % 4], cells_, sample);
    }
  }

  void collect(const SurfaceMap& surface, const LightMap& light, LightRows& rows,
               std::vector<LightEntry>& slots, std::vector<int>& used) const {
    const double share = 1.0 / samples_.count;
    for (std::size_t p = 0; p < used.size(); ++p) {
      const double albedo = surface.albedo.values[p];
      rows.ambient_cd_per_m2[p] += share * luminance_cd_per_m2(albedo, 0, ambient_lx_);
      if (!light.lit(p)) continue;
      slots[p * samples_.count + used[p]++] = {
          light.u_px.values[p], light.v_px.values[p],
          share * luminance_cd_per_m2(albedo, light.white_lx.values[p], 0), 0};
    }
  }

  void pack(const std::vector<LightEntry>& slots, const std::vector<int>& used, LightRows& rows) const {
    rows.begin.resize(used.size() + 1);
    rows.entries.clear();
    for (std::size_t p = 0; p < used.size(); ++p) {
      rows.begin[p] = std::uint32_t(rows.entries.size());
      const auto first = slots.begin() + std::ptrdiff_t(p * samples_.count);
      rows.entries.insert(rows.entries.end(), first, first + used[p]);
    }
    rows.begin.back() = std::uint32_t(rows.entries.size());
  }

  const RayScene& rays_;
  const CameraRays& directions_;
  CameraView camera_;
  ProjectorView projector_;
  int camera_index_;
  PixelSamples samples_;
  glm::ivec2 cells_;
  double ambient_lx_;
};

}  // namespace

void direct_rows(const SurfaceMap& surface, const LightMap& light, double ambient_lx, LightRows& rows) {
  const std::size_t pixels = rows.region.size();
  rows.begin.resize(pixels + 1);
  rows.ambient_cd_per_m2.resize(pixels);
  rows.entries.resize(pixels);
  std::uint32_t count = 0;
  for (int y = 0, p = 0; y < rows.region.height; ++y) {
    const glm::ivec2 first = glm::ivec2(rows.region.x, rows.region.y + y) - surface.first_px;
    const std::size_t begin = surface.albedo.index(first.x, first.y);
    for (std::size_t from = begin; from < begin + rows.region.width; ++from, ++p) {
      const double albedo = surface.albedo.values[from];
      rows.begin[p] = count;
      rows.ambient_cd_per_m2[p] = luminance_cd_per_m2(albedo, 0, ambient_lx);
      if (light.lit(from))
        rows.entries[count++] = {light.u_px.values[from], light.v_px.values[from],
                                 luminance_cd_per_m2(albedo, light.white_lx.values[from], 0), 0};
    }
  }
  rows.begin[pixels] = count;
  rows.entries.resize(count);
}

glm::vec2 sample_offset_px(const PixelSamples& samples, std::uint32_t camera, const glm::ivec2& pixel,
                           int sample) {
  if (samples.count == 1) return {0, 0};
  return place(draw(samples.seed, camera, pixel, sample / 4)[sample % 4], strata(samples.count), sample);
}

RowSource trace_rows(const RayScene& rays, const Scene& scene, int camera, const CameraRays& directions,
                     int projector, const PixelSamples& samples) {
  constexpr int most = 4096;
  if (samples.count < 1 || samples.count > most)
    throw InputError(fmt::format("samples per pixel: {} was found, expected a whole number from 1 to {}",
                                 samples.count, most));
  const auto tracer = std::make_shared<Tracer>(rays, scene, camera, directions, projector, samples);
  return [tracer](LightRows& rows) { (*tracer)(rows); };
}

}  // namespace laterna
