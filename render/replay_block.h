// Blocks of 64 camera pixels: what a show's frames are at each, before exposure. What replay is made of.
#pragma once

#include "render/light_rows.h"
#include "render/replay_kernels.h"
#include "render/show.h"
#include "sim/lookup.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace laterna {

/// How a show is played.
struct Playback {
  Lookup lookup;
  const Show& show;
  double scale;                                 // levels for 1 cd/m²
  std::vector<std::vector<float>> added_light;  // by source, one per frame, where any stack is not linear
};

Playback make_playback(Lookup lookup, const Show& show, double scale);

/// Up to 64 pixels of one image row, and what their playing needs. level = base + Σ gain·value, value in
/// 0..255.
struct ReplayBlock {
  int pixels;
  std::size_t first;           // index of the first pixel in the image
  const std::uint32_t* begin;  // CSR offsets into entries, pixels + 1
  const LightEntry* entries;
  const double* ambient;

  alignas(64) float base[block_pixels] = {};
  std::uint32_t first_tap[block_pixels + 1] = {};
  std::vector<BilinearTap> bilinear;
  std::vector<NearestTap> nearest;
  std::vector<TableTap> table;
  std::vector<BitTap> bits;
  std::vector<float> scratch, levels, mixed;  // levels[k·64 + i]: frames; mixed alike: pictures of a timeline
};

inline float gain_of(const LightEntry& entry, const Playback& play) {
  return static_cast<float>(play.scale / 255 * entry.weight);
}

inline std::uint64_t nearest_code(const LightEntry& entry, const BinaryPatternStack& patterns) {
  return patterns.code(nearest_texel(entry.u_px, patterns.width), nearest_texel(entry.v_px, patterns.height));
}

/// By source, the frames of each picture; empty without a timeline.
using RowTimeline = std::vector<std::vector<PictureFrames>>;

RowTimeline frames_of_row(const Show& show, int image_row);

/// The levels of every picture of a block, [k·64 + i] for picture k at pixel i.
const float* picture_levels(ReplayBlock& b, const Playback& play, const RowTimeline& timeline);

/// Calls play_block(b, x) for the blocks of row y of a region; x is the first pixel's place in the row.
template <class PlayBlock>
void for_each_block(ReplayBlock& b, const LightRows& rows, int y, int image_width,
                    const PlayBlock& play_block) {
  for (int x = 0; x < rows.region.width; x += block_pixels) {
    const std::size_t p = std::size_t(y) * rows.region.width + x;
    b.pixels = std::min(block_pixels, rows.region.width - x);
    b.first = std::size_t(rows.region.y + y) * image_width + rows.region.x + x;
    b.begin = rows.begin.data() + p;
    b.entries = rows.entries.data();
    b.ambient = rows.ambient_cd_per_m2.data() + p;
    play_block(b, x);
  }
}

}  // namespace laterna
