// Losses that let outliers go.
#pragma once

#include <cmath>

namespace laterna {

/// ρ(s) of a point's squared residual s = (du² + dv²)/σ²; the cost is ½ Σ ρ(s). ρ(s) = s near 0. With a =
/// scale_sigmas: Huber a²·(2·√(s/a²) - 1) beyond s = a²; Cauchy a²·log(1 + s/a²).
struct RobustLoss {
  enum class Kind { none, huber, cauchy };
  Kind kind = Kind::none;
  double scale_sigmas = 2;

  double rho(double s) const {
    const double a2 = scale_sigmas * scale_sigmas;
    if (kind == Kind::cauchy) return a2 * std::log1p(s / a2);
    if (kind == Kind::huber && s > a2) return a2 * (2 * std::sqrt(s / a2) - 1);
    return s;
  }
  /// dρ/ds: the weight of a point.
  double weight(double s) const {
    const double a2 = scale_sigmas * scale_sigmas;
    if (kind == Kind::cauchy) return 1 / (1 + s / a2);
    if (kind == Kind::huber && s > a2) return std::sqrt(a2 / s);
    return 1;
  }
  /// d²ρ/ds², at most 0.
  double weight_slope(double s) const {
    const double a2 = scale_sigmas * scale_sigmas;
    if (kind == Kind::cauchy) return -1 / (a2 * (1 + s / a2) * (1 + s / a2));
    if (kind == Kind::huber && s > a2) return -scale_sigmas / (2 * s * std::sqrt(s));
    return 0;
  }
};

}  // namespace laterna
