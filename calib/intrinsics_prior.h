// What is known of a device's intrinsics before any point is seen.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace laterna {

/// Gaussian and independent, of fx, fy, cx, cy (px) and the lens parameters. Empty: nothing is known.
struct IntrinsicsPrior {
  std::vector<double> mean, inverse_sigma;
  bool empty() const { return mean.empty(); }

  /// (k_i - mean_i)/sigma_i of the parameter with value k_i.
  double residual(std::size_t i, double value) const { return inverse_sigma[i] * (value - mean[i]); }
};

/// Σ ((k - mean)/sigma)².
inline double prior_loss(const IntrinsicsPrior& prior, std::span<const double> parameters) {
  double sum = 0;
  for (std::size_t i = 0; i < prior.mean.size(); ++i) sum += std::pow(prior.residual(i, parameters[i]), 2);
  return sum;
}

}  // namespace laterna
