// Many noisy solves of one projector: what sampling says, beside what covariances predict.
#pragma once

#include "calib/projection_rows.h"
#include "calib/solve.h"
#include "tests/calib/synthetic.h"

#include <functional>
#include <optional>

namespace laterna::testing {

/// eᵀ·C⁻¹·e by Cholesky; C row-major.
inline double mahalanobis(const std::vector<double>& e, const std::vector<double>& c) {
  const int p = int(e.size());
  std::vector<double> l(c.size(), 0.0), y(e);
  double sum = 0;
  for (int i = 0; i < p; ++i) {
    for (int j = 0; j <= i; ++j) {
      double s = c[i * p + j];
      for (int k = 0; k < j; ++k) s -= l[i * p + k] * l[j * p + k];
      l[i * p + j] = i == j ? std::sqrt(s) : s / l[j * p + j];
    }
    for (int k = 0; k < i; ++k) y[i] -= l[i * p + k] * y[k];
    y[i] /= l[i * p + i];
    sum += y[i] * y[i];
  }
  return sum;
}

struct Trials {
  std::vector<std::vector<double>> errors;  ///< tangent errors, one per trial
  std::vector<double> mahalanobis_over_p;   ///< by covariance_independent
  std::vector<double> volume_rms;           ///< true volume errors
  std::vector<double> predicted, predicted_independent;
  std::vector<Device> estimates;
  SolveResult first;
  int not_ok = 0;
};

/// `count` solves of `clean` with noise from `disturb`.
inline Trials run_trials(const Device& truth, const Correspondences& clean, int count,
                         const SolveOptions& options, const std::function<void(Correspondences&)>& disturb) {
  Trials t;
  for (int k = 0; k < count; ++k) {
    Correspondences noisy = clean;
    disturb(noisy);
    SolveResult r = solve(noisy, truth.intrinsics.size, options);
    t.not_ok += r.status != Status::ok;
    if (r.status == Status::refused) continue;
    t.errors.push_back(tangent_error(truth, r.estimate));
    t.mahalanobis_over_p.push_back(mahalanobis(t.errors.back(), r.covariance_independent) /
                                   double(t.errors.back().size()));
    t.volume_rms.push_back(verify(truth, r.estimate, {}, clean.world_points).volume.rms);
    t.predicted.push_back(r.predicted_volume_rms_px);
    t.predicted_independent.push_back(r.predicted_volume_rms_independent_px);
    t.estimates.push_back(r.estimate);
    if (k == 0) t.first = std::move(r);
  }
  return t;
}

inline double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / double(values.size());
}

inline double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / double(values.size()));
}

/// Radii (larger, smaller) of the one-sigma ellipse of a symmetric 2×2 matrix (xx, xy, yy).
inline glm::dvec2 ellipse_radii(double xx, double xy, double yy) {
  const double half = (xx + yy) / 2, root = std::hypot((xx - yy) / 2, xy);
  return {std::sqrt(half + root), std::sqrt(std::max(0.0, half - root))};
}

/// Predicted J·C·Jᵀ of one world point as ellipse radii.
inline glm::dvec2 predicted_radii(const Device& d, const std::vector<double>& c, const glm::dvec3& x) {
  const LensGradient lens(d.lens.model);
  const int p = lens.parameter_count() + 6;
  std::vector<double> rows(2 * std::size_t(p));
  double pixel[2], m[2][2] = {};
  project_with_rows(lens, state_of(d), x, pixel, rows.data());
  for (int r = 0; r < 2; ++r)
    for (int s = 0; s < 2; ++s)
      for (int i = 0; i < p; ++i)
        for (int j = 0; j < p; ++j) m[r][s] += rows[r * p + i] * c[i * p + j] * rows[s * p + j];
  return ellipse_radii(m[0][0], m[0][1], m[1][1]);
}

/// Sampled about the truth.
inline glm::dvec2 sampled_radii(const Device& truth, const std::vector<Device>& estimates,
                                const glm::dvec3& x) {
  double xx = 0, xy = 0, yy = 0;
  const glm::dvec3 there = WorldProjection(truth).project(x);
  for (const auto& estimate : estimates) {
    const glm::dvec3 e = WorldProjection(estimate).project(x) - there;
    xx += e.x * e.x, xy += e.x * e.y, yy += e.y * e.y;
  }
  const double n = double(estimates.size());
  return ellipse_radii(xx / n, xy / n, yy / n);
}

}  // namespace laterna::testing
