#include "render/replay.h"

#include "render/replay_block.h"
#include "render/replay_kernels.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace laterna {

namespace {

constexpr int block = block_pixels;
static_assert(sizeof(LightEntry) == 4 * sizeof(double) && offsetof(LightEntry, weight) == 2 * sizeof(double),
              "as nearest_codes() reads it");

// One sensor reading of a block in every picture, row by row to the planes.
template <class Number>
void expose_block(const ReplayBlock& b, const float* levels, const Exposure& exposure, int count,
                  std::vector<Number>& dn, Planes<Number> out) {
  dn.resize(std::size_t(count) * block);
  expose(exposure, std::uint32_t(b.first), count, levels, dn.data());
  for (int k = 0; k < count; ++k)
    std::copy_n(dn.data() + std::size_t(k) * block, b.pixels, out.first + k * out.stride);
}

// Black and white through at most one entry a pixel: two levels, no sums.
template <class Number>
void expand_block(const ReplayBlock& b, const Playback& play, const Exposure& exposure, Planes<Number> out) {
  const BinaryPatternStack& patterns = *play.show.sources[0].bits;
  alignas(64) std::uint64_t codes[block] = {};
  alignas(64) float levels[2 * block] = {};
  alignas(64) Number dn[2 * block];
  for (int i = 0; i < b.pixels; ++i)
    levels[i] = levels[block + i] = static_cast<float>(play.scale * b.ambient[i]);
  if (b.pixels == block && b.begin[block] - b.begin[0] == block) {
    nearest_codes({&b.entries[b.begin[0]].u_px, play.scale / 255},
                  {patterns.width, patterns.height, patterns.column_codes.data(), patterns.row_codes.data()},
                  codes, levels + block);
  } else {
    for (int i = 0; i < b.pixels; ++i) {
      if (b.begin[i] == b.begin[i + 1]) continue;
      const LightEntry& entry = b.entries[b.begin[i]];
      levels[block + i] += gain_of(entry, play) * 255.0f;
      codes[i] = nearest_code(entry, patterns);
    }
  }
  expose(exposure, std::uint32_t(b.first), 2, levels, dn);
  expand_bits(codes, dn, dn + block, b.pixels, patterns.count, out);
}

bool has_two_levels(const ReplayBlock& b, const Playback& play, const Exposure& exposure) {
  if (!play.show.binary() || play.show.sources.size() > 1 || play.show.timeline.frames_of_row ||
      play.lookup != Lookup::nearest || exposure.noise_sigma_dn > 0 || exposure.electrons)
    return false;
  bool several = false;
  for (int i = 0; i < b.pixels; ++i) several |= b.begin[i + 1] - b.begin[i] > 1;
  return !several;
}

// A row of all pictures is made in the cache first and written in long runs: planes whose sizes are multiples
// of 4096 bytes would push each other out of it.
template <class Number>
void play_region(const LightRows& rows, const Playback& play, const Exposure& exposure,
                 ImageStack<Number>& out) {
  const std::size_t width = rows.region.width, plane = out.picture_size();
  const int pictures = play.show.pictures();
  PixelArray<Number> stage(rows.region.width, pictures);
  std::vector<Number> dn;
  ReplayBlock b;
  for (int y = 0; y < rows.region.height; ++y) {
    const RowTimeline timeline = frames_of_row(play.show, rows.region.y + y);
    for_each_block(b, rows, y, out.width, [&](ReplayBlock&, int x) {
      const Planes<Number> planes{stage.values.data() + x, width};
      if (has_two_levels(b, play, exposure)) return expand_block(b, play, exposure, planes);
      expose_block(b, picture_levels(b, play, timeline), exposure, pictures, dn, planes);
    });
    Number* to = out.values.data() + std::size_t(rows.region.y + y) * out.width + rows.region.x;
    stream_rows(reinterpret_cast<const std::byte*>(stage.values.data()), width * sizeof(Number),
                width * sizeof(Number), pictures, reinterpret_cast<std::byte*>(to), plane * sizeof(Number));
  }
  finish_streams();
}

CapturedStack make_stack(const glm::ivec2& size, int count, const Exposure& exposure) {
  if (exposure.bit_depth == 8) return ImageStack<std::uint8_t>(size.x, size.y, count);
  return ImageStack<std::uint16_t>(size.x, size.y, count);
}

}  // namespace

ImageStack<float> play_luminance(const ImageRows& image, Lookup lookup, const Show& show) {
  const Playback play = make_playback(lookup, show, 1);
  ImageStack<float> out(image.size.x, image.size.y, show.pictures());
  for_each_region(image, [&](const LightRows& rows, std::size_t) {
    ReplayBlock b;
    for (int y = 0; y < rows.region.height; ++y) {
      const RowTimeline timeline = frames_of_row(show, rows.region.y + y);
      for_each_block(b, rows, y, image.size.x, [&](ReplayBlock&, int) {
        const float* levels = picture_levels(b, play, timeline);
        for (int k = 0; k < out.count; ++k)
          std::copy_n(levels + std::size_t(k) * block, b.pixels, out.picture(k).data() + b.first);
      });
    }
  });
  return out;
}

void play_rows(const LightRows& rows, Lookup lookup, const Show& show, const Exposure& exposure,
               CapturedStack& out) {
  const Playback play = make_playback(lookup, show, exposure.level_per_cd_per_m2());
  std::visit([&](auto& stack) { play_region(rows, play, exposure, stack); }, out);
}

void play_stack(const ImageRows& image, Lookup lookup, const Show& show, const Exposure& exposure,
                CapturedStack& out) {
  for_each_region(image,
                  [&](const LightRows& rows, std::size_t) { play_rows(rows, lookup, show, exposure, out); });
}

CapturedStack play_stack(const ImageRows& image, Lookup lookup, const Show& show, const Exposure& exposure) {
  CapturedStack out = make_stack(image.size, show.pictures(), exposure);
  play_stack(image, lookup, show, exposure, out);
  return out;
}

CapturedStack capture_stack(const SurfaceMap& surface, const LightMap& light, const Projector& projector,
                            const AnyPatterns& patterns, double ambient_lx, const Exposure& exposure) {
  const glm::ivec2 size = projector.device.intrinsics.size;
  if (patterns.width != size.x || patterns.height != size.y) {
    throw InputError(fmt::format("{}: patterns of {}x{} pixels, expected the projector's {}x{}",
                                 projector.device.name, patterns.width, patterns.height, size.x, size.y));
  }
  if (surface.width != light.width || surface.height != light.height) {
    throw InputError(fmt::format("{}: light of {}x{} camera pixels, expected the surface's {}x{}",
                                 projector.device.name, light.width, light.height, surface.width,
                                 surface.height));
  }
  const ImageRows image{{surface.width, surface.height},
                        [&](LightRows& rows) { direct_rows(surface, light, {}, ambient_lx, rows); }};
  return play_stack(image, projector.lookup, patterns, exposure);
}

}  // namespace laterna
