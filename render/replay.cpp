#include "render/replay.h"

#include "render/replay_kernels.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace laterna {

namespace {

constexpr int block = block_pixels;
static_assert(sizeof(LightEntry) == 4 * sizeof(double) && offsetof(LightEntry, weight) == 2 * sizeof(double),
              "as nearest_codes() reads it");

struct Play {
  Lookup lookup;
  const Show& show;
  double scale;                                 // levels for 1 cd/m²
  std::vector<std::vector<float>> added_light;  // by source, one per frame, where any stack is not linear
};

Play make_play(Lookup lookup, const Show& show, double scale) {
  Play play{lookup, show, scale, {}};
  const auto needs_table = [](const AnyPatterns& p) { return p.values && !p.values->is_linear(); };
  if (std::none_of(show.sources.begin(), show.sources.end(), needs_table)) return play;
  for (const AnyPatterns& source : show.sources) {
    play.added_light.push_back(source.values->added_light);
    play.added_light.back().resize(show.frames(), 0.0f);
  }
  return play;
}

// Up to 64 pixels of one image row, and what their playing needs. level = base + Σ gain·value, value in
// 0..255.
struct Block {
  int pixels;
  std::size_t first;           // index of the first pixel in the image
  const std::uint32_t* begin;  // CSR offsets into entries, pixels + 1
  const LightEntry* entries;
  const double* ambient;

  alignas(64) float base[block] = {};
  std::uint32_t first_tap[block + 1] = {};
  std::vector<BilinearTap> bilinear;
  std::vector<NearestTap> nearest;
  std::vector<TableTap> table;
  std::vector<BitTap> bits;
  std::vector<float> scratch, levels, mixed;  // levels[k·64 + i]: frames; mixed alike: pictures of a timeline
};

inline float gain_of(const LightEntry& entry, const Play& play) {
  return static_cast<float>(play.scale / 255 * entry.weight);
}

struct Corners {
  LinearTaps x, y;
};

template <class Stack>
Corners corners_of(const LightEntry& entry, const Stack& patterns) {
  return {linear_taps(entry.u_px, patterns.width), linear_taps(entry.v_px, patterns.height)};
}

inline const PatternStack& values_of(const LightEntry& entry, const Play& play) {
  return *play.show.sources[entry.source].values;
}

inline std::uint64_t nearest_code(const LightEntry& entry, const BinaryPatternStack& patterns) {
  return patterns.code(nearest_texel(entry.u_px, patterns.width), nearest_texel(entry.v_px, patterns.height));
}

// Asks for a texel's memory ahead of its use: stacks are larger than caches.
inline void fetch_ahead(const std::uint8_t* texel, int count) {
  for (int k = 0; k < count + 63; k += 64) __builtin_prefetch(texel + std::min(k, count - 1));
}

void add_tap(const LightEntry& entry, const Play& play, std::vector<NearestTap>& taps) {
  const PatternStack& p = values_of(entry, play);
  taps.push_back({p.texel(nearest_texel(entry.u_px, p.width), nearest_texel(entry.v_px, p.height)),
                  gain_of(entry, play)});
  fetch_ahead(taps.back().texel, p.count);
}

void add_tap(const LightEntry& entry, const Play& play, std::vector<BilinearTap>& taps) {
  const PatternStack& p = values_of(entry, play);
  const auto [x, y] = corners_of(entry, p);
  taps.push_back({p.texel(x.first, y.first), p.texel(x.second, y.first), p.texel(x.first, y.second),
                  p.texel(x.second, y.second), float(x.share), float(y.share), gain_of(entry, play)});
  fetch_ahead(taps.back().a, p.count);
  fetch_ahead(taps.back().d, p.count);
}

void add_tap(const LightEntry& entry, const Play& play, std::vector<TableTap>& taps) {
  const PatternStack& p = values_of(entry, play);
  const auto gain = static_cast<float>(play.scale * entry.weight);
  const auto add = [&](int x, int y, float share) {
    taps.push_back(
        {p.texel(x, y), p.light_of_value.data(), play.added_light[entry.source].data(), gain * share});
  };
  if (play.lookup == Lookup::nearest) {
    add(nearest_texel(entry.u_px, p.width), nearest_texel(entry.v_px, p.height), 1);
    return;
  }
  const auto [x, y] = corners_of(entry, p);
  const auto right = static_cast<float>(x.share), below = static_cast<float>(y.share);
  add(x.first, y.first, (1 - right) * (1 - below));
  add(x.second, y.first, right * (1 - below));
  add(x.first, y.second, (1 - right) * below);
  add(x.second, y.second, right * below);
}

void add_tap(const LightEntry& entry, const Play& play, std::vector<BitTap>& taps) {
  const BinaryPatternStack& p = *play.show.sources[entry.source].bits;
  const float gain = gain_of(entry, play) * 255.0f;
  if (play.lookup == Lookup::nearest) {
    taps.push_back({nearest_code(entry, p), gain});
    return;
  }
  const auto [x, y] = corners_of(entry, p);
  const auto right = static_cast<float>(x.share), below = static_cast<float>(y.share);
  taps.push_back({p.code(x.first, y.first), gain * (1 - right) * (1 - below)});
  taps.push_back({p.code(x.second, y.first), gain * right * (1 - below)});
  taps.push_back({p.code(x.first, y.second), gain * (1 - right) * below});
  taps.push_back({p.code(x.second, y.second), gain * right * below});
}

constexpr int all_sources = -1;  // and constant light

template <class Tap>
void sum_entries(Block& b, const Play& play, int source, std::vector<Tap>& taps) {
  const int count = play.show.frames();
  taps.clear();
  for (int i = 0; i < b.pixels; ++i) {
    b.base[i] = source == all_sources ? static_cast<float>(play.scale * b.ambient[i]) : 0.0f;
    b.first_tap[i] = std::uint32_t(taps.size());
    for (std::uint32_t e = b.begin[i]; e < b.begin[i + 1]; ++e)
      if (source == all_sources || int(b.entries[e].source) == source) add_tap(b.entries[e], play, taps);
  }
  b.first_tap[b.pixels] = std::uint32_t(taps.size());
  b.scratch.resize(std::size_t(padded(count)) * block);
  b.levels.resize(std::size_t(padded(count)) * block);
  sum_taps(taps.data(), b.first_tap, b.base, b.pixels, count, b.scratch.data(), b.levels.data());
}

// Fills b.levels.
void sum_block(Block& b, const Play& play, int source) {
  if (play.show.binary()) return sum_entries(b, play, source, b.bits);
  if (!play.added_light.empty()) return sum_entries(b, play, source, b.table);
  if (play.lookup == Lookup::nearest) return sum_entries(b, play, source, b.nearest);
  return sum_entries(b, play, source, b.bilinear);
}

// Adds to pictures what each of them integrates of a source's frames.
void mix_frames(Block& b, const std::vector<PictureFrames>& pictures) {
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    float* to = b.mixed.data() + k * block;
    for (const FrameShare& f : pictures[k]) {
      const float* from = b.levels.data() + std::size_t(f.frame) * block;
      for (int i = 0; i < block; ++i) to[i] += f.share * from[i];
    }
  }
}

// By source, the frames of each picture; empty without a timeline.
using RowTimeline = std::vector<std::vector<PictureFrames>>;

RowTimeline frames_of_row(const Show& show, int image_row) {
  RowTimeline timeline;
  if (!show.timeline.frames_of_row) return timeline;
  for (int source = 0; source < int(show.sources.size()); ++source)
    timeline.push_back(show.timeline.frames_of_row(image_row, source));
  return timeline;
}

// The levels of every picture of a block.
const float* picture_levels(Block& b, const Play& play, const RowTimeline& timeline) {
  if (timeline.empty()) {
    sum_block(b, play, all_sources);
    return b.levels.data();
  }
  b.mixed.assign(std::size_t(play.show.pictures()) * block, 0);
  for (std::size_t k = 0; k < b.mixed.size(); k += block)
    for (int i = 0; i < b.pixels; ++i) b.mixed[k + i] = static_cast<float>(play.scale * b.ambient[i]);
  for (int source = 0; source < int(timeline.size()); ++source) {
    sum_block(b, play, source);
    mix_frames(b, timeline[source]);
  }
  return b.mixed.data();
}

// One sensor reading of a block in every picture, row by row to the planes.
template <class Number>
void expose_block(const Block& b, const float* levels, const Exposure& exposure, int count,
                  std::vector<Number>& dn, Planes<Number> out) {
  dn.resize(std::size_t(count) * block);
  expose(exposure, std::uint32_t(b.first), count, levels, dn.data());
  for (int k = 0; k < count; ++k)
    std::copy_n(dn.data() + std::size_t(k) * block, b.pixels, out.first + k * out.stride);
}

// Black and white through at most one entry a pixel: two levels, no sums.
template <class Number>
void expand_block(const Block& b, const Play& play, const Exposure& exposure, Planes<Number> out) {
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

bool has_two_levels(const Block& b, const Play& play, const Exposure& exposure) {
  if (!play.show.binary() || play.show.sources.size() > 1 || play.show.timeline.frames_of_row ||
      play.lookup != Lookup::nearest || exposure.noise_sigma_dn > 0 || exposure.electrons)
    return false;
  bool several = false;
  for (int i = 0; i < b.pixels; ++i) several |= b.begin[i + 1] - b.begin[i] > 1;
  return !several;
}

// Calls play_block(b, x) for the blocks of row y of a region; x is the first pixel's place in the row.
template <class PlayBlock>
void for_each_block(Block& b, const LightRows& rows, int y, int image_width, const PlayBlock& play_block) {
  for (int x = 0; x < rows.region.width; x += block) {
    const std::size_t p = std::size_t(y) * rows.region.width + x;
    b.pixels = std::min(block, rows.region.width - x);
    b.first = std::size_t(rows.region.y + y) * image_width + rows.region.x + x;
    b.begin = rows.begin.data() + p;
    b.entries = rows.entries.data();
    b.ambient = rows.ambient_cd_per_m2.data() + p;
    play_block(b, x);
  }
}

// A row of all pictures is made in the cache first and written in long runs: planes whose sizes are multiples
// of 4096 bytes would push each other out of it.
template <class Number>
void play_region(const LightRows& rows, const Play& play, const Exposure& exposure, ImageStack<Number>& out) {
  const std::size_t width = rows.region.width, plane = out.picture_size();
  const int pictures = play.show.pictures();
  PixelArray<Number> stage(rows.region.width, pictures);
  std::vector<Number> dn;
  Block b;
  for (int y = 0; y < rows.region.height; ++y) {
    const RowTimeline timeline = frames_of_row(play.show, rows.region.y + y);
    for_each_block(b, rows, y, out.width, [&](Block&, int x) {
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

void scatter(const LightRows& rows, Lookup lookup, const Image<float>& camera_image, std::uint32_t source,
             Image<double>& sum) {
  for (std::size_t p = 0; p < rows.region.size(); ++p) {
    const int x = rows.region.x + int(p) % rows.region.width, y = rows.region.y + int(p) / rows.region.width;
    for (std::uint32_t e = rows.begin[p]; e < rows.begin[p + 1]; ++e) {
      const LightEntry& entry = rows.entries[e];
      if (entry.source != source) continue;
      const double value = entry.weight * camera_image(x, y);
      if (lookup == Lookup::nearest) {
        sum(nearest_texel(entry.u_px, sum.width), nearest_texel(entry.v_px, sum.height)) += value;
        continue;
      }
      const LinearTaps u = linear_taps(entry.u_px, sum.width), v = linear_taps(entry.v_px, sum.height);
      sum(u.first, v.first) += value * (1 - u.share) * (1 - v.share);
      sum(u.second, v.first) += value * u.share * (1 - v.share);
      sum(u.first, v.second) += value * (1 - u.share) * v.share;
      sum(u.second, v.second) += value * u.share * v.share;
    }
  }
}

}  // namespace

ImageStack<float> play_luminance(const ImageRows& image, Lookup lookup, const Show& show) {
  const Play play = make_play(lookup, show, 1);
  ImageStack<float> out(image.size.x, image.size.y, show.pictures());
  for_each_region(image, [&](const LightRows& rows, std::size_t) {
    Block b;
    for (int y = 0; y < rows.region.height; ++y) {
      const RowTimeline timeline = frames_of_row(show, rows.region.y + y);
      for_each_block(b, rows, y, image.size.x, [&](Block&, int) {
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
  const Play play = make_play(lookup, show, exposure.level_per_cd_per_m2());
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

Image<double> apply_transpose(const ImageRows& image, Lookup lookup, const Image<float>& camera_image,
                              glm::ivec2 projector_size, std::uint32_t source) {
  constexpr std::size_t batch = 64;  // regions traced at once; added one after the other, for the same bits
  Image<double> sum(projector_size.x, projector_size.y);
  const std::size_t count = region_count(image);
  for (std::size_t first = 0; first < count; first += batch) {
    std::vector<LightRows> parts(std::min(batch, count - first));
    for_each_region(image, first, parts.size(),
                    [&](LightRows& rows, std::size_t index) { parts[index - first] = std::move(rows); });
    for (const LightRows& part : parts) scatter(part, lookup, camera_image, source, sum);
  }
  return sum;
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
