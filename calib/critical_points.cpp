#include "calib/critical_points.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

// Up to 4000 points with their middle at the origin and spread 1 along each principal axis; none where flat.
Eigen::MatrixXd whitened(std::span<const glm::dvec3> points) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / 4000);
  const glm::dvec3 origin = points.front();
  Eigen::MatrixXd x(Eigen::Index((points.size() - 1) / step + 1), 3);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const glm::dvec3 d = points[std::size_t(i) * step] - origin;
    x.row(i) << d.x, d.y, d.z;
  }
  x.rowwise() -= x.colwise().mean().eval();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(x, Eigen::ComputeThinU);
  if (!(svd.singularValues()[2] > 1e-9 * svd.singularValues()[0])) return {};
  return svd.matrixU() * std::sqrt(double(x.rows()));
}

// rms distance of points from the quadric q, to first order: |q(x)| over |∇q|.
double distance(const Eigen::MatrixXd& points, const Eigen::MatrixXd& monomials, const Eigen::VectorXd& q) {
  double slope = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const double x = points(i, 0), y = points(i, 1), z = points(i, 2);
    slope +=
        Eigen::Vector3d(2 * q[0] * x + q[3] * y + q[4] * z + q[6], 2 * q[1] * y + q[3] * x + q[5] * z + q[7],
                        2 * q[2] * z + q[4] * x + q[5] * y + q[8])
            .squaredNorm();
  }
  return (monomials * q).norm() / std::sqrt(std::max(slope, 1e-300));
}

}  // namespace

CriticalSet critical_set(std::span<const glm::dvec3> points) {
  constexpr double near = 0.1;
  if (points.size() < 12) return CriticalSet::none;
  const Eigen::MatrixXd x = whitened(points);
  if (x.rows() < 12) return CriticalSet::none;
  Eigen::MatrixXd monomials(x.rows(), 10);
  monomials << x.cwiseProduct(x), x.col(0).cwiseProduct(x.col(1)), x.col(0).cwiseProduct(x.col(2)),
      x.col(1).cwiseProduct(x.col(2)), x, Eigen::VectorXd::Ones(x.rows());
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(monomials, Eigen::ComputeThinV);
  int quadrics = 0;  // from the best fit on
  while (quadrics < 4 && distance(x, monomials, svd.matrixV().col(9 - quadrics)) < near) ++quadrics;
  return quadrics == 3   ? CriticalSet::twisted_cubic
         : quadrics == 2 ? CriticalSet::plane_and_line
                         : CriticalSet::none;
}

std::string critical_in_words(CriticalSet set) {
  switch (set) {
    case CriticalSet::none:
      break;
    case CriticalSet::twisted_cubic:
      return "the points lie near a critical curve: all of them on a twisted cubic through the projector's "
             "centre, where it can slide; add points off the curve";
    case CriticalSet::plane_and_line:
      return "the points lie near a critical set: a plane, and a line through the projector's centre, along "
             "which it can slide; add points off both";
  }
  return {};
}

}  // namespace laterna
