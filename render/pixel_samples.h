// Where the samples of a camera pixel lie.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace laterna {

/// Each camera pixel is the mean of `count` rays.
struct PixelSamples {
  int count = 1;  ///< 1: the pixel's centre, exactly
  std::uint64_t seed = 0;
  double side_px = 1;  ///< of the square about the pixel's centre over which they are spread; 0: none
};

/// What a ray's random point is for: points for different uses are independent.
enum class SampleUse : std::uint32_t { pixel, aperture, airy };

/// Columns and rows into which a square is cut for `count` stratified samples: columns·rows = count, as near
/// to square as count's divisors allow.
glm::ivec2 cells(int count);

/// A point of [-0.5, 0.5)² for one ray. The square is cut into cells(count), and each ray is uniform in a
/// cell of its own: Philox4x32-10 with counter
/// (x, y, 2¹⁶·use + sample/4, camera) under the key `seed`. Which ray has which cell: in order for
/// SampleUse::pixel, else by a permutation that is drawn for each pixel and use, so that the mean over rays
/// is that over all pairs of points (after Kensler, "Correlated multi-jittered sampling", 2013).
glm::vec2 stratified_square(const PixelSamples& samples, std::uint32_t camera, const glm::ivec2& pixel,
                            int sample, SampleUse use);

/// The unit disc from [-0.5, 0.5)², areas kept up to the factor 4/π: concentric squares become concentric
/// circles. After Shirley & Chiu, "A low distortion map between disk and square", 1997.
glm::vec2 disc_from_square(const glm::vec2& square);

/// Where sample `sample` of a camera's pixel lies beside the pixel's centre: stratified_square times side_px.
/// (0, 0) where count is 1.
glm::vec2 sample_offset_px(const PixelSamples& samples, std::uint32_t camera, const glm::ivec2& pixel,
                           int sample);

}  // namespace laterna
