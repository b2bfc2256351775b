// Counter-based random numbers: the same bits for any order of pixels and any number of threads.
#pragma once

#include <cstdint>

namespace laterna {

/// What a picture's noise depends on, beside picture and pixel.
struct NoiseKey {
  std::uint64_t seed = 0;
  std::uint32_t camera = 0, projector = 0;  ///< indices into the scene
};

/// Four independent standard normal deviates for pictures 4·group to 4·group + 3 at one pixel: Philox4x32-10
/// (Salmon et al., "Parallel Random Numbers: As Easy as 1, 2, 3", SC 2011), counter (pixel, group, camera,
/// projector) under the key `seed`, then Box and Muller's transform.
void normal_deviates(const NoiseKey& key, std::uint32_t pixel, std::uint32_t group, float deviates[4]);

}  // namespace laterna
