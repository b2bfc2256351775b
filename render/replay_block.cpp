#include "render/replay_block.h"

#include <algorithm>

namespace laterna {

namespace {

constexpr int block = block_pixels;

struct Corners {
  LinearTaps x, y;
};

template <class Stack>
Corners corners_of(const LightEntry& entry, const Stack& patterns) {
  return {linear_taps(entry.u_px, patterns.width), linear_taps(entry.v_px, patterns.height)};
}

inline const PatternStack& values_of(const LightEntry& entry, const Playback& play) {
  return *play.show.sources[entry.source].values;
}

// Asks for a texel's memory ahead of its use: stacks are larger than caches.
inline void fetch_ahead(const std::uint8_t* texel, int count) {
  for (int k = 0; k < count + 63; k += 64) __builtin_prefetch(texel + std::min(k, count - 1));
}

void add_tap(const LightEntry& entry, const Playback& play, std::vector<NearestTap>& taps) {
  const PatternStack& p = values_of(entry, play);
  taps.push_back({p.texel(nearest_texel(entry.u_px, p.width), nearest_texel(entry.v_px, p.height)),
                  gain_of(entry, play)});
  fetch_ahead(taps.back().texel, p.count);
}

void add_tap(const LightEntry& entry, const Playback& play, std::vector<BilinearTap>& taps) {
  const PatternStack& p = values_of(entry, play);
  const auto [x, y] = corners_of(entry, p);
  taps.push_back({p.texel(x.first, y.first), p.texel(x.second, y.first), p.texel(x.first, y.second),
                  p.texel(x.second, y.second), float(x.share), float(y.share), gain_of(entry, play)});
  fetch_ahead(taps.back().a, p.count);
  fetch_ahead(taps.back().d, p.count);
}

void add_tap(const LightEntry& entry, const Playback& play, std::vector<TableTap>& taps) {
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

void add_tap(const LightEntry& entry, const Playback& play, std::vector<BitTap>& taps) {
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
void sum_entries(ReplayBlock& b, const Playback& play, int source, std::vector<Tap>& taps) {
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
void sum_block(ReplayBlock& b, const Playback& play, int source) {
  if (play.show.binary()) return sum_entries(b, play, source, b.bits);
  if (!play.added_light.empty()) return sum_entries(b, play, source, b.table);
  if (play.lookup == Lookup::nearest) return sum_entries(b, play, source, b.nearest);
  return sum_entries(b, play, source, b.bilinear);
}

// Adds to pictures what each of them integrates of a source's frames.
void mix_frames(ReplayBlock& b, const std::vector<PictureFrames>& pictures) {
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    float* to = b.mixed.data() + k * block;
    for (const FrameShare& f : pictures[k]) {
      const float* from = b.levels.data() + std::size_t(f.frame) * block;
      for (int i = 0; i < block; ++i) to[i] += f.share * from[i];
    }
  }
}

}  // namespace

Playback make_playback(Lookup lookup, const Show& show, double scale) {
  Playback play{lookup, show, scale, {}};
  const auto needs_table = [](const AnyPatterns& p) { return p.values && !p.values->is_linear(); };
  if (std::none_of(show.sources.begin(), show.sources.end(), needs_table)) return play;
  for (const AnyPatterns& source : show.sources) {
    play.added_light.push_back(source.values->added_light);
    play.added_light.back().resize(show.frames(), 0.0f);
  }
  return play;
}

RowTimeline frames_of_row(const Show& show, int image_row) {
  RowTimeline timeline;
  if (!show.timeline.frames_of_row) return timeline;
  for (int source = 0; source < int(show.sources.size()); ++source)
    timeline.push_back(show.timeline.frames_of_row(image_row, source));
  return timeline;
}

const float* picture_levels(ReplayBlock& b, const Playback& play, const RowTimeline& timeline) {
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

}  // namespace laterna
