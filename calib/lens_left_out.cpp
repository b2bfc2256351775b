#include "calib/lens_left_out.h"

#include "calib/covariance.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int terms = 4,
              first_term = 4;        // among the tangent columns fx, fy, cx, cy, lens, rotation, translation
constexpr double least_gap = 1e-10;  // of the scaled columns

double wald_of(const Eigen::VectorXd& k, const Eigen::MatrixXd& covariance) {
  return k.dot(covariance.ldlt().solve(k));
}

ProjectorState stepped(const ProjectorState& from, const Eigen::VectorXd& step) {
  ProjectorState to = from;
  const Eigen::Index intrinsics = Eigen::Index(to.parameters.size());
  for (Eigen::Index i = 0; i < intrinsics; ++i) to.parameters[std::size_t(i)] += step[i];
  const auto part = [&](Eigen::Index at) { return glm::dvec3(step[at], step[at + 1], step[at + 2]); };
  to.device_from_points.rotation =
      rigid_from_rotation_vector(part(intrinsics), glm::dvec3(0.0)).rotation * to.device_from_points.rotation;
  to.device_from_points.translation += part(intrinsics + 3);
  return to;
}

}  // namespace

std::optional<LensLeftOut> lens_left_out(const PointTable& points, const ProjectorState& state,
                                         const RobustLoss& loss, const WorldNormalisation& normalisation,
                                         glm::ivec2 size, double least_wald) {
  const LensGradient lens("LENSMODEL_OPENCV4");
  ProjectorState larger = state;
  larger.parameters.resize(4 + terms, 0.0);
  const auto factor = row_factor(points, lens, larger, loss);
  const int p = lens.parameter_count() + 6;
  if (!factor) return {};
  const auto singular = scaled_spectrum(*factor, p).singular_values;
  if (!(singular.back() > least_gap * singular.front())) return {};
  const RowMajor all = Eigen::Map<const RowMajor>(factor->data(), p + 1, p + 1);
  const auto r = all.topLeftCorner(p, p).triangularView<Eigen::Upper>();
  const Eigen::VectorXd step = -r.solve(all.col(p).head(p));
  const Eigen::MatrixXd inverse = r.solve(Eigen::MatrixXd::Identity(p, p));
  const double spare = std::max(1.0, 2 * double(points.size()) - p);
  const double variance = std::max(1.0, all(p, p) * all(p, p) / spare);
  const Eigen::MatrixXd independent = variance * inverse * inverse.transpose();
  const Eigen::VectorXd k = step.segment(first_term, terms);
  LensLeftOut left{{}, wald_of(k, independent.block(first_term, first_term, terms, terms))};
  const auto clustered =
      left.wald < least_wald ? std::nullopt : clustered_covariance(points, lens, larger, loss, *factor);
  if (clustered) {
    const RowMajor c = Eigen::Map<const RowMajor>(clustered->data(), p, p);
    left.wald = std::min(left.wald, wald_of(k, c.block(first_term, first_term, terms, terms)));
  }
  const ProjectorState moved = stepped(larger, step);
  const auto& m = moved.parameters;
  left.device.intrinsics = {size, m[0], m[1], m[2], m[3]};
  left.device.device_from_world = device_from_world(moved.device_from_points, normalisation);
  left.device.lens = {"LENSMODEL_OPENCV4", {m.begin() + 4, m.end()}};
  return std::isfinite(left.wald) ? std::optional(left) : std::nullopt;
}

}  // namespace laterna
