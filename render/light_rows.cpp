#include "render/light_rows.h"

#include "render/exposure.h"

namespace laterna {

void RowBuilder::finish(LightRows& rows) const {
  rows.begin.assign(count_.size() + 1, 0);
  for (std::size_t p = 0; p < count_.size(); ++p) rows.begin[p + 1] = rows.begin[p] + count_[p];
  std::vector<std::uint32_t> next(rows.begin.begin(), rows.begin.end() - 1);
  rows.entries.resize(entries_.size());
  for (std::size_t e = 0; e < entries_.size(); ++e) rows.entries[next[pixel_[e]]++] = entries_[e];
}

double constant_luminance_cd_per_m2(const SurfaceMap& surface, std::span<const IdleLight> idle,
                                    double ambient_lx, std::size_t p) {
  const double albedo = surface.albedo.values[p];
  double luminance = luminance_cd_per_m2(albedo, 0, ambient_lx);
  for (const IdleLight& i : idle)
    if (i.light->lit(p)) luminance += luminance_cd_per_m2(albedo, i.share * i.light->white_lx.values[p], 0);
  return luminance;
}

void direct_rows(const SurfaceMap& surface, const LightMap& light, std::span<const IdleLight> idle,
                 double ambient_lx, LightRows& rows) {
  const std::size_t pixels = rows.region.size();
  rows.begin.resize(pixels + 1);
  rows.ambient_cd_per_m2.resize(pixels);
  rows.entries.resize(pixels);
  std::uint32_t count = 0;
  for (int y = 0, p = 0; y < rows.region.height; ++y) {
    const glm::ivec2 first = glm::ivec2(rows.region.x, rows.region.y + y) - surface.first_px;
    const std::size_t begin = surface.albedo.index(first.x, first.y);
    for (std::size_t from = begin; from < begin + rows.region.width; ++from, ++p) {
      rows.begin[p] = count;
      rows.ambient_cd_per_m2[p] = constant_luminance_cd_per_m2(surface, idle, ambient_lx, from);
      if (light.lit(from)) {
        const double albedo = surface.albedo.values[from];
        rows.entries[count++] = {light.u_px.values[from], light.v_px.values[from],
                                 luminance_cd_per_m2(albedo, light.white_lx.values[from], 0),
                                 light.footprint(from)};
      }
    }
  }
  rows.begin[pixels] = count;
  rows.entries.resize(count);
}

}  // namespace laterna
