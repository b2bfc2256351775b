// Where the samples of a camera pixel lie.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace laterna {

/// Antialiasing: each camera pixel is the mean of `count` rays.
struct PixelSamples {
  int count = 1;  ///< 1: the pixel's centre, exactly
  std::uint64_t seed = 0;
};

/// Where sample `sample` of a camera's pixel lies beside the pixel's centre, in [-0.5, 0.5)². The pixel is
/// cut into columns × rows = count cells, as near to square as count's divisors allow, and each sample is
/// uniform in a cell of its own: Philox4x32-10 with counter (x, y, sample/4, camera) under the key `seed`.
/// (0, 0) where count is 1.
glm::vec2 sample_offset_px(const PixelSamples& samples, std::uint32_t camera, const glm::ivec2& pixel,
                           int sample);

}  // namespace laterna
