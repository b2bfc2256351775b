#include "render/effects/colour.h"

#include "render/effects/slide.h"

#include <algorithm>
#include <array>
#include <utility>

namespace laterna {

namespace {

using Channels = std::array<glm::dvec3, 3>;

Channels mixing_of(const Scene& scene, int camera, int projector) {
  for (const ColourMixing& mixing : scene.mixings)
    if (mixing.camera == camera && mixing.projector == projector) return mixing.channels;
  return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

double sum(const glm::dvec3& v) { return v.x + v.y + v.z; }

// The mosaic repeats every two pixels each way.
struct Mosaic {
  std::array<std::array<glm::dvec3, 2>, 2> seen;  // [y mod 2][x mod 2]
  glm::dvec3 shares;
  bool each_primary;

  void add(const LightEntry& entry, const glm::dvec3& weights, std::vector<LightEntry>& out) const {
    LightEntry coloured = entry;
    for (std::uint32_t j = 0; j < 3; ++j) {
      coloured.weight = entry.weight * weights[int(j)];
      coloured.source = 3 * entry.source + j;
      if (coloured.weight > 0) out.push_back(coloured);
    }
  }

  void operator()(LightRows& rows) const {
    std::vector<LightEntry> out;
    out.reserve(rows.entries.size() * (each_primary ? 3 : 1));
    for (std::size_t p = 0; p < rows.region.size(); ++p) {
      const int x = rows.region.x + int(p) % rows.region.width,
                y = rows.region.y + int(p) / rows.region.width;
      const glm::dvec3& white = seen[y % 2][x % 2];
      const glm::dvec3 weights = white * shares;
      rows.ambient_cd_per_m2[p] *= sum(white);
      const std::uint32_t first = rows.begin[p];
      rows.begin[p] = std::uint32_t(out.size());
      for (std::uint32_t e = first; e < rows.begin[p + 1]; ++e) {
        if (each_primary) {
          add(rows.entries[e], weights, out);
        } else if (sum(weights) > 0) {
          out.push_back(rows.entries[e]);
          out.back().weight *= sum(weights);
        }
      }
    }
    rows.begin.back() = std::uint32_t(out.size());
    rows.entries = std::move(out);
  }
};

}  // namespace

bool patterns_have_colour(const Scene& scene) {
  const std::span<const Slide> slides = shown_slides(scene);
  return scene.effects.colour &&
         std::any_of(slides.begin(), slides.end(), [](const Slide& s) { return !s.primaries.empty(); });
}

int channel_at(ColourFilter filter, const glm::ivec2& camera_pixel) {
  static constexpr std::array<std::array<int, 4>, 4> mosaics{
      {{0, 1, 1, 2}, {2, 1, 1, 0}, {1, 0, 2, 1}, {1, 2, 0, 1}}};  // rggb, bggr, grbg, gbrg
  return mosaics[std::size_t(filter) - 1][2 * (camera_pixel.y % 2) + camera_pixel.x % 2];
}

glm::dvec3 primaries_seen(const Scene& scene, int camera, int projector, const glm::ivec2& camera_pixel) {
  const Channels m = mixing_of(scene, camera, projector);
  const ColourFilter filter = scene.cameras[camera].colour_filter;
  if (filter == ColourFilter::mono) return (m[0] + m[1] + m[2]) / 3.0;
  return m[channel_at(filter, camera_pixel)];
}

RowSource apply_colour(RowSource rows, const Scene& scene, int camera, int projector, bool each_primary) {
  if (!scene.effects.colour) return rows;
  Mosaic mosaic{{}, scene.pattern_colour, each_primary};
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) mosaic.seen[y][x] = primaries_seen(scene, camera, projector, {x, y});
  return [mosaic, white = std::move(rows)](LightRows& region) {
    white(region);
    mosaic(region);
  };
}

}  // namespace laterna
