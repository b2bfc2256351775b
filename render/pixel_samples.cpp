#include "render/pixel_samples.h"

#include <Random123/philox.h>

#include <cmath>

namespace laterna {

namespace {

// The cells that a pixel is cut into.
glm::ivec2 strata(int count) {
  int rows = static_cast<int>(std::sqrt(double(count)));
  while (count % rows != 0) --rows;
  return {count / rows, rows};
}

// Two times 16 bits for a sample; four samples share a draw.
std::uint32_t draw(const PixelSamples& samples, std::uint32_t camera, const glm::ivec2& pixel, int sample) {
  using Philox = r123::Philox4x32;
  const Philox::key_type key{{std::uint32_t(samples.seed), std::uint32_t(samples.seed >> 32)}};
  const Philox::ctr_type counter{
      {std::uint32_t(pixel.x), std::uint32_t(pixel.y), std::uint32_t(sample / 4), camera}};
  return Philox()(counter, key)[sample % 4];
}

}  // namespace

glm::vec2 sample_offset_px(const PixelSamples& samples, std::uint32_t camera, const glm::ivec2& pixel,
                           int sample) {
  if (samples.count == 1) return {0, 0};
  const glm::ivec2 cells = strata(samples.count);
  const std::uint32_t bits = draw(samples, camera, pixel, sample);
  const glm::vec2 cell(sample % cells.x, sample / cells.x);
  const glm::vec2 inside = (glm::vec2(bits & 0xffffu, bits >> 16) + 0.5f) * 0x1p-16f;
  return (cell + inside) / glm::vec2(cells) - 0.5f;
}

}  // namespace laterna
