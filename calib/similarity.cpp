#include "calib/similarity.h"

#include "calib/correspondences.h"
#include "calib/median.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace laterna {

namespace {

constexpr int samples = 200, rounds = 20;
constexpr std::size_t judged_pairs = 500;
constexpr double on_a_line = 1e-6;  // of variances
constexpr double rounding = 1e-12;

Eigen::Vector3d eigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

double scale_alone(std::span<const glm::dvec3> a, std::span<const glm::dvec3> b, std::span<const double> w) {
  double ab = 0, aa = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    ab += w[i] * glm::dot(a[i], b[i]), aa += w[i] * glm::dot(a[i], a[i]);
  return ab / aa;
}

glm::dvec3 weighted_mean(std::span<const glm::dvec3> points, std::span<const double> w) {
  glm::dvec3 sum(0.0);
  double weight = 0;
  for (std::size_t i = 0; i < points.size(); ++i) sum += w[i] * points[i], weight += w[i];
  return sum / weight;
}

// Σ w (b - mean b)(a - mean a)ᵀ = U·S·Vᵀ; R = U·diag(1, 1, ±1)·Vᵀ; s = tr(S·diag(1, 1, ±1))/Σ w|a - mean a|².
std::optional<Similarity> with_motion(std::span<const glm::dvec3> a, std::span<const glm::dvec3> b,
                                      std::span<const double> w, bool scales) {
  const glm::dvec3 mean_a = weighted_mean(a, w), mean_b = weighted_mean(b, w);
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  double spread_a = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    cross += w[i] * eigen(b[i] - mean_b) * eigen(a[i] - mean_a).transpose();
    spread_a += w[i] * glm::dot(a[i] - mean_a, a[i] - mean_a);
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& s = svd.singularValues();
  if (!(s[1] > on_a_line * s[0])) return std::nullopt;
  const double sign = svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;
  const Eigen::Matrix3d r =
      svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
  Similarity fit;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) fit.rotation[column][row] = r(row, column);
  if (scales) fit.scale = (s[0] + s[1] + sign * s[2]) / spread_a;
  fit.translation = mean_b - fit.scale * (fit.rotation * mean_a);
  return fit;
}

std::optional<Similarity> least_squares(std::span<const glm::dvec3> a, std::span<const glm::dvec3> b,
                                        std::span<const double> w, const SimilarityOptions& options) {
  std::optional<Similarity> fit = Similarity{};
  if (options.motion)
    fit = with_motion(a, b, w, options.scale);
  else if (options.scale)
    fit->scale = scale_alone(a, b, w);
  if (fit && !(fit->scale > 0 && std::isfinite(fit->scale))) return std::nullopt;
  return fit;
}

std::vector<double> residuals(const Similarity& fit, std::span<const glm::dvec3> a,
                              std::span<const glm::dvec3> b) {
  std::vector<double> r(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) r[i] = glm::distance(apply(fit, a[i]), b[i]);
  return r;
}

std::optional<Similarity> best_sample(std::span<const glm::dvec3> a, std::span<const glm::dvec3> b,
                                      const SimilarityOptions& options) {
  std::vector<glm::dvec3> some_a, some_b;
  for (const std::size_t i : evenly_spread(a.size(), judged_pairs))
    some_a.push_back(a[i]), some_b.push_back(b[i]);
  std::mt19937_64 random(options.seed);
  std::optional<Similarity> best;
  double least = std::numeric_limits<double>::infinity();
  for (int sample = 0; sample < samples; ++sample) {
    std::array<glm::dvec3, 3> three_a, three_b;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = random() % some_a.size();
      three_a[k] = some_a[i], three_b[k] = some_b[i];
    }
    const auto fit = least_squares(three_a, three_b, std::array{1.0, 1.0, 1.0}, options);
    if (!fit) continue;
    const double middle = median(residuals(*fit, some_a, some_b));
    if (middle < least) least = middle, best = fit;
  }
  return best;
}

}  // namespace

std::optional<Similarity> fit_similarity(std::span<const glm::dvec3> a, std::span<const glm::dvec3> b,
                                         const SimilarityOptions& options) {
  if (a.size() < 3 || a.size() != b.size()) return std::nullopt;
  std::optional<Similarity> fit = best_sample(a, b, options);
  std::vector<double> w(a.size());
  double size = 0;
  for (const glm::dvec3& x : b) size = std::max(size, glm::length(x));
  for (int round = 0; fit && round < rounds; ++round) {
    const std::vector<double> r = residuals(*fit, a, b);
    const double width = std::max(3 * median(r), rounding * size);
    std::transform(r.begin(), r.end(), w.begin(),
                   [&](double e) { return std::pow(1 + (e / width) * (e / width), -2); });
    fit = least_squares(a, b, w, options);
  }
  return fit;
}

}  // namespace laterna
