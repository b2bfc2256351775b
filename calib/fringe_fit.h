// The pictures of one fringe to phase, modulation and variance, pixel by pixel.
//
// I_j = A + B·cos(φ + δ_j), δ_j = 2π·j/N. Least squares gives
//   σ_φ² = 4/(N²·B²)·Σ_j σ_j²·sin²(φ + δ_j),  which for a constant σ_I is 2·σ_I²/(N·B²).
// With samples at full scale left out (three must remain) the general form is Σ_j σ_j²·(∂φ/∂I_j)².
#pragma once

#include "calib/decoded_map.h"
#include "sim/image_view.h"
#include "sim/pattern_sequence.h"

#include <cstddef>
#include <vector>

namespace laterna {

/// The standard deviation of a sample: σ² = constant_dn² + variance_per_dn·max(I - black, 0), black being the
/// black picture's sample there. Of shot noise, variance_per_dn is the system gain in DN per electron.
struct SampleNoise {
  double constant_dn = 1;
  double variance_per_dn = 0;
};

struct FringeLimits {
  double full_scale_dn = 255;
  double min_modulation_dn = 4;      ///< B at least this
  double min_modulation_sigmas = 5;  ///< and σ_φ at most 1/this
};

/// Arrays of `count` pixels.
struct FringeFit {
  std::vector<float> mean, c, s;  ///< A, B·cos φ, B·sin φ in DN
  std::vector<float> turns;       ///< φ/2π in [0, 1)
  std::vector<float> variance;    ///< of turns; infinite where rejected
  std::vector<Reject> why;
};

/// Fits the pixels from `begin` on. What the sinusoid and the sum of the pictures (calib/sum_check.h) leave
/// over is tested too: where its χ² per degree of freedom (N - 2 of them) is above 9, the variance grows by
/// that factor. So a dropped picture or a bent response shows in sigma, for N = 3 too. A pixel whose white is
/// at full scale lacks the sum's degree of freedom.
template <class T>
FringeFit fit_fringe(const ImageStackView<T>& stack, const PatternGroup& group, const SampleNoise& noise,
                     const FringeLimits& limits, std::size_t begin, std::size_t count);
template <class T>
FringeFit fit_fringe(const ImageStack<T>& stack, const PatternGroup& group, const SampleNoise& noise,
                     const FringeLimits& limits, std::size_t begin, std::size_t count) {
  return fit_fringe(ImageStackView<T>(stack), group, noise, limits, begin, count);
}

}  // namespace laterna
