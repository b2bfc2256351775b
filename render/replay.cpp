#include "render/replay.h"

#include "sim/error.h"
#include "sim/parallel.h"

#include <fmt/format.h>

#include <algorithm>

namespace laterna {

namespace {

// Pixels of a row that are played together: 64, one cache line of each 8-bit picture.
constexpr int block = noise_pixels;

// A pixel's level (Exposure) is dark + gain·value, value in 0..255.
struct Block {
  float dark[block], gain[block];
  int pixels;
  std::size_t first;  // index of the first pixel
};

struct Play {
  const SurfaceMap& surface;
  const LightMap& light;
  const PatternStack& patterns;
  double ambient_lx;
  const Exposure& exposure;
};

void find_levels(Block& b, const Play& play) {
  const double scale = play.exposure.level_per_cd_per_m2();
  for (int i = 0; i < b.pixels; ++i) {
    const std::size_t p = b.first + i;
    const double albedo = play.surface.albedo.values[p];
    b.dark[i] = static_cast<float>(scale * luminance_cd_per_m2(albedo, 0, play.ambient_lx));
    b.gain[i] =
        static_cast<float>(scale / 255 * luminance_cd_per_m2(albedo, play.light.white_lx.values[p], 0));
  }
}

// values[k·block + i]: picture k at the block's pixel i. Dark pixels have gain 0 and may hold anything.
void fetch_nearest(const Block& b, const Play& play, std::uint8_t* values) {
  for (int i = 0; i < b.pixels; ++i) {
    const std::size_t p = b.first + i;
    if (!play.light.lit(p)) continue;
    const std::uint8_t* texel =
        play.patterns.texel(nearest_texel(play.light.u_px.values[p], play.patterns.width),
                            nearest_texel(play.light.v_px.values[p], play.patterns.height));
    for (int k = 0; k < play.patterns.count; ++k) values[k * block + i] = texel[k];
  }
}

void fetch_bilinear(const Block& b, const Play& play, float* values) {
  const PatternStack& patterns = play.patterns;
  for (int i = 0; i < b.pixels; ++i) {
    const std::size_t p = b.first + i;
    if (!play.light.lit(p)) continue;
    const LinearTaps x = linear_taps(play.light.u_px.values[p], patterns.width);
    const LinearTaps y = linear_taps(play.light.v_px.values[p], patterns.height);
    const std::uint8_t *a = patterns.texel(x.first, y.first), *c = patterns.texel(x.second, y.first),
                       *d = patterns.texel(x.first, y.second), *e = patterns.texel(x.second, y.second);
    const auto right = static_cast<float>(x.share), below = static_cast<float>(y.share);
    for (int k = 0; k < patterns.count; ++k) {
      const float upper = a[k] + right * float(c[k] - a[k]), lower = d[k] + right * float(e[k] - d[k]);
      values[k * block + i] = upper + below * (lower - upper);
    }
  }
}

template <class Value, class Number>
void expose_values(const Block& b, const Play& play, const Value* values, std::vector<float>& levels,
                   std::vector<Number>& dn, ImageStack<Number>& out) {
  const int count = play.patterns.count;
  for (int k = 0; k < count; ++k) {
    for (int i = 0; i < block; ++i)
      levels[k * block + i] = b.dark[i] + b.gain[i] * float(values[k * block + i]);
  }
  expose(play.exposure, std::uint32_t(b.first), count, levels.data(), dn.data());
  for (int k = 0; k < count; ++k)
    std::copy_n(dn.data() + k * block, b.pixels, out.picture(k).data() + b.first);
}

template <class Value, class Number, class Fetch>
ImageStack<Number> play_stack(const Play& play, const Fetch& fetch) {
  ImageStack<Number> out(play.surface.width, play.surface.height, play.patterns.count);
  parallel_for(out.height, [&](std::size_t y) {
    Block b{};
    const std::size_t held = std::size_t(play.patterns.count) * block;
    std::vector<Value> values(held);
    std::vector<float> levels(held);
    std::vector<Number> dn(held);
    for (int x = 0; x < out.width; x += block) {
      b.first = y * out.width + x;
      b.pixels = std::min(block, out.width - x);
      find_levels(b, play);
      fetch(b, play, values.data());
      expose_values(b, play, values.data(), levels, dn, out);
    }
  });
  return out;
}

template <class Number>
ImageStack<Number> play_lookup(const Play& play, Lookup lookup) {
  if (lookup == Lookup::nearest) return play_stack<std::uint8_t, Number>(play, fetch_nearest);
  return play_stack<float, Number>(play, fetch_bilinear);
}

}  // namespace

CapturedStack capture_stack(const SurfaceMap& surface, const LightMap& light, const Projector& projector,
                            const PatternStack& patterns, double ambient_lx, const Exposure& exposure) {
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
  const Play play{surface, light, patterns, ambient_lx, exposure};
  if (exposure.bit_depth == 8) return play_lookup<std::uint8_t>(play, projector.lookup);
  return play_lookup<std::uint16_t>(play, projector.lookup);
}

}  // namespace laterna
