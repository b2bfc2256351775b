#include "calib/selfcal/critical_pair.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

namespace laterna {

namespace {

using Matrix3 = Eigen::Matrix3d;
using Vector9 = Eigen::Matrix<double, 9, 1>;

glm::dmat3 to_glm(const Matrix3& m) { return glm::make_mat3(m.data()); }
Matrix3 to_eigen(const glm::dmat3& m) { return Eigen::Map<const Matrix3>(glm::value_ptr(m)); }

Eigen::Vector3d homogeneous(const glm::dvec2& p) { return {p.x, p.y, 1}; }

// The sigma of bᵀ·M·a, in pixels.
double algebraic_sigma(const StationPair& p, std::size_t i, const Matrix3& m) {
  const Eigen::Vector3d ma = m * homogeneous(p.pixel_a[i]), mb = m.transpose() * homogeneous(p.pixel_b[i]);
  return std::hypot(p.sigma_b[i] * ma.head<2>().norm(), p.sigma_a[i] * mb.head<2>().norm());
}

}  // namespace

std::optional<double> other_matrix_scale(const StationPair& pair, const glm::dmat3& fundamental) {
  if (pair.size() < 12) return std::nullopt;
  const Matrix3 ta = to_eigen(normalised_from_pixel(pair.pixel_a)),
                tb = to_eigen(normalised_from_pixel(pair.pixel_b));
  Matrix3 m = to_eigen(fundamental);
  const Matrix3 f = tb.inverse().transpose() * m * ta.inverse();  // of normalised pixels
  const Vector9 along = Eigen::Map<const Vector9>(f.data()).normalized();
  const Eigen::Matrix<double, 9, 8> beside =
      (Eigen::HouseholderQR<Vector9>(along).householderQ() * Eigen::Matrix<double, 9, 9>::Identity())
          .rightCols<8>();
  double scale = INFINITY;
  for (int round = 0; round < 5; ++round) {
    Eigen::Matrix<double, 9, 9> moments = Eigen::Matrix<double, 9, 9>::Zero();
    for (std::size_t i = 0; i < pair.size(); ++i) {
      const Matrix3 row =  // column-major, as the matrix that it meets
          (tb * homogeneous(pair.pixel_b[i])) * (ta * homogeneous(pair.pixel_a[i])).transpose();
      const double sigma = algebraic_sigma(pair, i, m);
      const Vector9 v = Eigen::Map<const Vector9>(row.data()) / std::max(sigma, 1e-300);
      moments += v * v.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 8, 8>> eigen(beside.transpose() * moments *
                                                                           beside);
    const Vector9 other = beside * eigen.eigenvectors().col(0);
    m = tb.transpose() * Eigen::Map<const Matrix3>(other.data()) * ta;
    double sum = 0;
    for (const double r : epipolar_residuals(pair, to_glm(m))) sum += r * r;
    if (std::isfinite(sum)) scale = std::min(scale, std::sqrt(sum / double(pair.size() - 7)));
  }
  return scale;
}

bool on_critical_surface(const StationPair& pair, const PairGeometry& geometry) {
  const auto other = other_matrix_scale(pair, geometry.fundamental);
  return other && *other < 1.2 * std::max(1.0, geometry.epipolar_scale);
}

}  // namespace laterna
