#include "calib/error_directions.h"

#include "calib/projection_rows.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace laterna {

std::vector<double> error_directions(const Device& device, std::span<const glm::dvec3> points_world,
                                     std::span<const glm::dvec2> errors_px) {
  const LensGradient lens(device.lens.model);
  const int p = lens.parameter_count() + 6;
  const WorldNormalisation normalisation = normalisation_of(points_world);
  ProjectorState state = state_of(device);
  state.device_from_points = device_from_normalised(state.device_from_points, normalisation);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(p, p);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(p);
  Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor> rows(2, p);
  double energy = 0, pixel[2];
  for (std::size_t i = 0; i < points_world.size(); ++i) {
    const glm::dvec3 x = (points_world[i] - normalisation.center) / normalisation.scale_m;
    const Eigen::Vector2d e(errors_px[i].x, errors_px[i].y);
    if (!e.allFinite() || !project_with_rows(lens, state, x, pixel, rows.data())) continue;
    information += rows.transpose() * rows;
    gradient += rows.transpose() * e;
    energy += e.squaredNorm();
  }
  std::vector<double> shares(p, 0.0);
  if (!(energy > 0)) return shares;
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * information *
                                                              scale.asDiagonal());
  for (int i = 0; i < p; ++i) {
    const int column = p - 1 - i;  // Eigen sorts upwards
    const double along = solver.eigenvectors().col(column).dot(scale.cwiseProduct(gradient));
    shares[i] = along * along / std::max(solver.eigenvalues()[column], 1e-15) / energy;
  }
  return shares;
}

}  // namespace laterna
