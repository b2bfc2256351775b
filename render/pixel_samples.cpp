#include "render/pixel_samples.h"

#include <Random123/philox.h>

#include <bit>
#include <cmath>
#include <numbers>

namespace laterna {

namespace {

using Philox = r123::Philox4x32;

Philox::ctr_type draw(const PixelSamples& samples, std::uint32_t camera, const glm::ivec2& pixel,
                      std::uint32_t index, SampleUse use) {
  const Philox::key_type key{{std::uint32_t(samples.seed), std::uint32_t(samples.seed >> 32)}};
  const Philox::ctr_type counter{
      {std::uint32_t(pixel.x), std::uint32_t(pixel.y), (std::uint32_t(use) << 16) + index, camera}};
  return Philox()(counter, key);
}

// A permutation of 0..count-1: steps that are each a bijection of the next power of two, walked until the
// result is in range.
int permuted(int sample, int count, const Philox::ctr_type& key) {
  const int bits = std::bit_width(std::uint32_t(count - 1));
  const std::uint32_t mask = (1u << bits) - 1;
  std::uint32_t x = std::uint32_t(sample);
  do {
    for (const std::uint32_t k : key) {
      x = ((x ^ k) * (k >> 8 | 1)) & mask;
      x ^= x >> ((bits + 1) / 2);
    }
  } while (x >= std::uint32_t(count));
  return int(x);
}

}  // namespace

glm::ivec2 cells(int count) {
  int rows = static_cast<int>(std::sqrt(double(count)));
  while (count % rows != 0) --rows;
  return {count / rows, rows};
}

glm::vec2 stratified_square(const PixelSamples& samples, std::uint32_t camera, const glm::ivec2& pixel,
                            int sample, SampleUse use) {
  // Two times 16 bits for a sample; four samples share a draw.
  const std::uint32_t bits = draw(samples, camera, pixel, std::uint32_t(sample) / 4, use)[sample % 4];
  const int cell_index = use == SampleUse::pixel || samples.count == 1
                             ? sample
                             : permuted(sample, samples.count, draw(samples, camera, pixel, 0xffff, use));
  const glm::ivec2 grid = cells(samples.count);
  const glm::vec2 cell(cell_index % grid.x, cell_index / grid.x);
  const glm::vec2 inside = (glm::vec2(bits & 0xffffu, bits >> 16) + 0.5f) * 0x1p-16f;
  return (cell + inside) / glm::vec2(grid) - 0.5f;
}

glm::vec2 disc_from_square(const glm::vec2& square) {
  constexpr float quarter_turn = std::numbers::pi_v<float> / 4;
  const glm::vec2 s = 2.0f * square;
  if (s == glm::vec2(0)) return {0, 0};
  const bool wide = std::abs(s.x) > std::abs(s.y);
  const float radius = wide ? s.x : s.y;
  const float angle = wide ? quarter_turn * (s.y / s.x) : quarter_turn * (2 - s.x / s.y);
  return radius * glm::vec2(std::cos(angle), std::sin(angle));
}

glm::vec2 sample_offset_px(const PixelSamples& samples, std::uint32_t camera, const glm::ivec2& pixel,
                           int sample) {
  if (samples.count == 1) return {0, 0};
  return float(samples.side_px) * stratified_square(samples, camera, pixel, sample, SampleUse::pixel);
}

}  // namespace laterna
