#include "calib/selfcal/turned.h"

#include "sim/rigid.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace laterna {

namespace {

using Matrix3 = Eigen::Matrix3d;
constexpr double pixel_scale = 1000;

struct TurnResidual {
  glm::dvec2 a, b;
  double inverse_sigma;
  bool one_focal_a, one_focal_b;
  template <class T>
  bool operator()(const T* ka, const T* kb, const T* turn, T* residual) const {
    const T ray[3] = {(a.x / pixel_scale - ka[2]) / ka[0],
                      (a.y / pixel_scale - ka[3]) / ka[one_focal_a ? 0 : 1], T(1)};
    T x[3];
    ceres::AngleAxisRotatePoint(turn, ray, x);
    if (!(x[2] > T(1e-6))) return false;
    residual[0] = ((kb[0] * x[0] / x[2] + kb[2]) * pixel_scale - b.x) * inverse_sigma;
    residual[1] = ((kb[one_focal_b ? 0 : 1] * x[1] / x[2] + kb[3]) * pixel_scale - b.y) * inverse_sigma;
    return true;
  }
};

bool one_focal(const TrackDevice& d) { return d.focal && !d.aspect; }

void hold(ceres::Problem& problem, const TrackDevice& d, double* k) {
  if (d.free_count() == 0) return problem.SetParameterBlockConstant(k);
  std::vector<int> held;
  if (!d.focal) held.push_back(0);
  if (!d.aspect) held.push_back(1);
  if (!d.center) held.insert(held.end(), {2, 3});
  if (!held.empty()) problem.SetManifold(k, new ceres::SubsetManifold(4, held));
}

std::array<double, 4> block_of(const TrackDevice& d, double ratio) {
  const Intrinsics& k = d.intrinsics;
  const double f = ratio * k.size.x;
  return {(d.focal ? f : k.fx) / pixel_scale, (d.focal ? f : k.fy) / pixel_scale, k.cx / pixel_scale,
          k.cy / pixel_scale};
}

// The rotation nearest to K_b⁻¹·H·K_a.
glm::dvec3 nearest_turn(const glm::dmat3& h, const std::array<double, 4>& a, const std::array<double, 4>& b) {
  const auto matrix = [](const std::array<double, 4>& k) {
    return glm::dmat3(k[0], 0, 0, 0, k[1], 0, k[2], k[3], 1 / pixel_scale) * pixel_scale;
  };
  const glm::dmat3 g = glm::inverse(matrix(b)) * h * matrix(a);
  Matrix3 m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = g[j][i];
  if (m.determinant() < 0) m = -m;
  const Eigen::JacobiSVD<Matrix3> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::AngleAxisd turn(Matrix3(svd.matrixU() * svd.matrixV().transpose()));
  const Eigen::Vector3d w = turn.angle() * turn.axis();
  return {w.x(), w.y(), w.z()};
}

// The sigma of point i as b sees it, a's noise carried over by the homography's change of area.
double sigma_in_b(const StationPair& pair, std::size_t i, const glm::dmat3& h) {
  const double w = (h * glm::dvec3(pair.pixel_a[i], 1)).z;
  return std::hypot(pair.sigma_b[i],
                    pair.sigma_a[i] * std::sqrt(std::abs(glm::determinant(h) / (w * w * w))));
}

double solve(const StationPair& pair, const TrackDevice& a, const TrackDevice& b, const glm::dmat3& h,
             double ratio_a, double ratio_b) {
  std::array<double, 4> ka = block_of(a, ratio_a), kb = block_of(b, ratio_b);
  glm::dvec3 turn = nearest_turn(h, ka, kb);
  ceres::Problem problem;
  for (std::size_t i = 0; i < pair.size(); ++i)
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<TurnResidual, 2, 4, 4, 3>(new TurnResidual{
            pair.pixel_a[i], pair.pixel_b[i], 1 / sigma_in_b(pair, i, h), one_focal(a), one_focal(b)}),
        nullptr, ka.data(), kb.data(), &turn.x);
  hold(problem, a, ka.data()), hold(problem, b, kb.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 100;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return std::sqrt(2 * std::max(0.0, summary.final_cost) / double(2 * pair.size()));
}

}  // namespace

std::optional<double> turned_scale(const StationPair& pair, const TrackDevice& a, const TrackDevice& b,
                                   const glm::dmat3& homography) {
  if (a.free_count() + b.free_count() >= 5) return std::nullopt;
  double best = INFINITY;
  for (const double ratio_a : {0.7, 1.5, 3.0})
    for (const double ratio_b : {0.7, 1.5, 3.0}) {
      if ((!a.focal && ratio_a > 1) || (!b.focal && ratio_b > 1)) continue;
      const double scale = solve(pair, a, b, homography, ratio_a, ratio_b);
      if (std::isfinite(scale)) best = std::min(best, scale);
    }
  return best;
}

}  // namespace laterna
