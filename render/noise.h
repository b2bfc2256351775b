// Counter-based random numbers: the same bits for any order of pixels and any number of threads.
#pragma once

#include <cstdint>

namespace laterna {

/// What a picture's noise depends on, beside picture and pixel.
struct NoiseKey {
  std::uint64_t seed = 0;
  std::uint32_t camera = 0, projector = 0;  ///< indices into the scene
};

/// Draws of different streams are independent.
enum class NoiseStream : std::uint32_t { temporal, shot, non_uniformity };

/// Noise is drawn for this many pixels and for four pictures at a time: value i + 64·j belongs to pixel
/// first_pixel + i and picture 4·group + j, for any first_pixel.
inline constexpr int noise_pixels = 64, noise_pictures = 4, noise_values = noise_pixels * noise_pictures;

/// Uniform 32-bit words: Threefry4x32 with 12 rounds (Salmon et al., "Parallel Random Numbers: As Easy as 1,
/// 2, 3", SC 2011; the fewest that pass all of TestU01), which unlike their Philox needs no 64-bit
/// products and so vectorises everywhere. Counter (pixel, group, stream, 0) under the key (seed, camera,
/// projector); word j is picture 4·group + j.
void random_words(const NoiseKey& key, NoiseStream stream, std::uint32_t first_pixel, std::uint32_t group,
                  std::uint32_t* words);

/// Independent standard normal deviates by Box and Muller's transform of random_words(): pictures 0 and 1
/// share two words, 2 and 3 the others. Single precision: within 1e-6 of the transform (relative to the
/// radius); |deviate| ≤ 6.67, beyond which 3e-11 of a normal distribution lie. The same bits on every
/// instruction set.
void normal_deviates(const NoiseKey& key, NoiseStream stream, std::uint32_t first_pixel, std::uint32_t group,
                     float* deviates);

/// Poisson-distributed counts for 64 pixels, by inversion: the least n with word/2³² < P(N ≤ n). Means above
/// 0 and below 30; 0 for all others. Single precision: P(N ≤ n) within 4e-6; the tail ends at μ + 6.5·√μ + 4,
/// which is passed with a chance below 1e-8. The same bits on every instruction set.
void poisson_counts(const float* means, const std::uint32_t* words, float* counts);
inline constexpr float greatest_poisson_mean = 30;

}  // namespace laterna
