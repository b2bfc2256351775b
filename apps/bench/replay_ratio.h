// What replay costs beside a streaming fill of the same bytes, and a stack from scene to pictures.
#pragma once

#include "sim/scene.h"

namespace laterna {

/// Seconds, medians over repeats taken in turn; ratios are medians of the ratios within each repeat.
struct ReplayTimes {
  double fill = 0;      ///< writing the stack's bytes once, with the threads that are set
  double binary = 0;    ///< Gray stack as bits, nearest, no noise; rows warm in the cache, as they are
                        ///< when traced region by region
  double bilinear = 0;  ///< the same pictures as an 8-bit stack, bilinear, no noise
  double noise = 0;     ///< the same with the sensor's noise of 1.5 DN
  double binary_over_fill = 0, bilinear_over_fill = 0;
  double noise_over_replay = 0;      ///< what noise adds to `bilinear`, over `bilinear`
  double std_normal_over_noise = 0;  ///< per sample: std::normal_distribution over normal_deviates()
};
ReplayTimes time_replay(const Scene& scene, int repeats);

/// A Gray stack from the scene in memory to pictures in memory without noise: build, trace, expose, play.
/// `sixteen`: the same with 16 samples per camera pixel.
struct StackTimes {
  double one = 0, sixteen = 0;
  double ratio = 0;  ///< 16 samples over one, of what samples multiply: tracing and replay, not the build
};
StackTimes time_stack(const Scene& scene, int repeats);

/// The whole round trip in memory with noise: build, trace, capture, decode, solve, verify. Median seconds.
double time_roundtrip(const Scene& scene, int repeats);

}  // namespace laterna
