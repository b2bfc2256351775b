// Pictures of pattern sequences for the decoders' tests: a camera that looks straight at the panel, or
// through an affine map.
#pragma once

#include "sim/pattern_sequence.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace laterna {

inline std::uint8_t clamp_dn(double value) {
  return std::uint8_t(std::lround(std::clamp(value, 0.0, 255.0)));
}

/// Pixel upon pixel; `dn` turns a pattern's value (0 to 255) into what the camera reads.
inline ImageStack<std::uint8_t> straight(
    const PatternSequence& sequence,
    const std::function<double(double)>& dn = [](double v) { return 10 + 0.9 * v; }) {
  const int count = picture_count(sequence);
  ImageStack<std::uint8_t> stack(sequence.projector_size.x, sequence.projector_size.y, count);
  const PatternStack patterns = make_pattern_stack(sequence);
  for (std::size_t i = 0; i < stack.picture_size(); ++i)
    for (int k = 0; k < count; ++k) stack.picture(k)[i] = clamp_dn(dn(patterns.values[i * count + k]));
  return stack;
}

/// A camera pixel (x, y) is the mean of samples² points of the projector's picture around `place(x, y)`, read
/// as boxes, `dn_noise` added.
inline ImageStack<std::uint8_t> seen(const PatternSequence& sequence, glm::ivec2 camera, int samples,
                                     const std::function<glm::dvec2(glm::dvec2)>& place, double noise_dn,
                                     std::mt19937_64& random) {
  const PatternStack patterns = make_pattern_stack(sequence);
  ImageStack<std::uint8_t> stack(camera.x, camera.y, patterns.count);
  std::normal_distribution<double> noise(0, noise_dn > 0 ? noise_dn : 1);
  std::vector<double> sum(patterns.count);
  for (int y = 0; y < camera.y; ++y) {
    for (int x = 0; x < camera.x; ++x) {
      std::fill(sum.begin(), sum.end(), 0.0);
      for (int s = 0; s < samples * samples; ++s) {
        const glm::dvec2 offset = (glm::dvec2(s % samples, s / samples) + 0.5) / double(samples) - 0.5;
        const glm::dvec2 p = glm::round(place(glm::dvec2(x, y) + offset));
        if (p.x < 0 || p.y < 0 || p.x >= patterns.width || p.y >= patterns.height) continue;
        for (int k = 0; k < patterns.count; ++k) sum[k] += patterns.texel(int(p.x), int(p.y))[k];
      }
      for (int k = 0; k < patterns.count; ++k) {
        const double value = 20 + 0.8 * sum[k] / (samples * samples);
        stack.picture(k)[std::size_t(y) * camera.x + x] =
            clamp_dn(value + (noise_dn > 0 ? noise(random) : 0));
      }
    }
  }
  return stack;
}

/// Families that decode densely, for a given size.
inline std::vector<PatternSequence> coded_families(glm::ivec2 size) {
  std::vector<PatternSequence> all;
  const auto add = [&](PatternParameters p) { all.push_back({p, size}); };
  add({.kind = PatternKind::gray});
  add({.kind = PatternKind::xor_gray});
  add({.kind = PatternKind::xor_gray, .xor_stripe_px = 4});
  add({.kind = PatternKind::gray_phase, .steps = 3, .pitch_px = 16});
  add({.kind = PatternKind::gray_phase, .steps = 4, .pitch_px = 23.7});
  add({.kind = PatternKind::phase, .steps = 5, .pitch_px = 40});
  add({.kind = PatternKind::multi_frequency, .steps = 4, .pitch_px = 20});
  add({.kind = PatternKind::multi_frequency, .steps = 3, .pitches_px = {28, 19, 23}});
  add({.kind = PatternKind::micro_phase, .steps = 3, .pitch_px = 16});
  return all;
}

}  // namespace laterna
