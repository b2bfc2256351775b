#include "calib/camera_uncertainty.h"

#include "sim/parallel.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr std::size_t chunk = 4096;
constexpr double grazing = 0.0175;  // sine of 1°

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

glm::dvec3 translation_row(const std::vector<double>& rows, int p, int r) {
  return {rows[r * p + p - 3], rows[r * p + p - 2], rows[r * p + p - 1]};
}

// ∂pixel/∂x from ∂pixel/∂t: row·R.
Eigen::RowVector3d by_point(const glm::dvec3& by_translation, const glm::dmat3& rotation) {
  const glm::dvec3 row = glm::transpose(rotation) * by_translation;
  return {row.x, row.y, row.z};
}

// Σ JᵀwE and Σ EᵀwE of one camera.
struct Sums {
  Eigen::MatrixXd cross, square;
};

struct CameraTerms {
  LensGradient lens;
  ProjectorState state;
  int parameters;  // 0: certain
};

std::vector<CameraTerms> terms_of(const Correspondences& c) {
  std::vector<CameraTerms> terms;
  for (const UncertainCamera& camera : c.cameras) {
    const LensGradient lens(camera.device.lens.model);
    terms.push_back(
        {lens, state_of(camera.device), camera.covariance.empty() ? 0 : lens.parameter_count() + 6});
  }
  return terms;
}

std::vector<Sums> zeros(const std::vector<CameraTerms>& cameras, int p) {
  std::vector<Sums> sums;
  for (const CameraTerms& c : cameras)
    sums.push_back(
        {Eigen::MatrixXd::Zero(p, c.parameters), Eigen::MatrixXd::Zero(c.parameters, c.parameters)});
  return sums;
}

struct Problem {
  const Correspondences& points;
  const WorldNormalisation& normalisation;
  const LensGradient& lens;
  const ProjectorState& state;
  const RobustLoss& loss;
};

// The weighted rows [J | E] of one point go into its camera's sums.
void add_point(const Problem& problem, std::size_t i, const CameraTerms& camera, std::vector<double>& rows,
               std::vector<double>& derivative, Sums& sums) {
  const Correspondences& c = problem.points;
  const int p = problem.lens.parameter_count() + 6, q = camera.parameters;
  if (q == 0 ||
      !point_by_camera(camera.lens, camera.state, c.world_points[i], c.normals_world[i], derivative))
    return;
  const glm::dvec3 x = (c.world_points[i] - problem.normalisation.center) / problem.normalisation.scale_m;
  double pixel[2];
  if (!project_with_rows(problem.lens, problem.state, x, pixel, rows.data())) return;
  const double du = pixel[0] - c.projector_pixels[i].x, dv = pixel[1] - c.projector_pixels[i].y;
  const double w = 1 / (c.sigma_px[i] * c.sigma_px[i]);
  const double weight = w * problem.loss.weight(w * (du * du + dv * dv));
  Eigen::Matrix<double, 2, 3> by_x;
  for (int r = 0; r < 2; ++r)
    by_x.row(r) = by_point(translation_row(rows, p, r), problem.state.device_from_points.rotation) /
                  problem.normalisation.scale_m;
  const RowMajor e = by_x * Eigen::Map<const RowMajor>(derivative.data(), 3, q);
  const Eigen::Map<const RowMajor> j(rows.data(), 2, p);
  sums.cross.noalias() += weight * j.transpose() * e;
  sums.square.noalias() += weight * e.transpose() * e;
}

std::vector<Sums> all_sums(const Problem& problem, const std::vector<CameraTerms>& cameras) {
  const int p = problem.lens.parameter_count() + 6;
  const std::size_t count = problem.points.world_points.size();
  std::vector<std::vector<Sums>> parts((count + chunk - 1) / chunk);
  parallel_for(parts.size(), [&](std::size_t k) {
    parts[k] = zeros(cameras, p);
    std::vector<double> rows(2 * std::size_t(p)), derivative;
    for (std::size_t i = k * chunk; i < std::min(count, (k + 1) * chunk); ++i) {
      const std::uint32_t c = problem.points.camera[i];
      add_point(problem, i, cameras[c], rows, derivative, parts[k][c]);
    }
  });
  std::vector<Sums> sums = zeros(cameras, p);
  for (const std::vector<Sums>& part : parts) {
    for (std::size_t c = 0; c < sums.size(); ++c)
      sums[c].cross += part[c].cross, sums[c].square += part[c].square;
  }
  return sums;
}

}  // namespace

bool point_by_camera(const LensGradient& lens, const ProjectorState& camera, const glm::dvec3& x,
                     const glm::dvec3& normal, std::vector<double>& derivative) {
  const int p = lens.parameter_count() + 6;
  const Rigid& pose = camera.device_from_points;
  const glm::dvec3 ray = glm::normalize(glm::transpose(pose.rotation) * apply(pose, x));
  if (!(std::abs(glm::dot(ray, normal)) > grazing)) return false;
  thread_local std::vector<double> rows;
  rows.resize(2 * std::size_t(p));
  double pixel[2];
  if (!project_with_rows(lens, camera, x, pixel, rows.data())) return false;
  Eigen::Matrix3d by_x;
  for (int r = 0; r < 2; ++r) by_x.row(r) = by_point(translation_row(rows, p, r), pose.rotation);
  // The plane's row in the size of the others, for the elimination's sake.
  by_x.row(2) = by_x.row(0).norm() * Eigen::RowVector3d(normal.x, normal.y, normal.z);
  RowMajor by_camera = RowMajor::Zero(3, p);
  by_camera.topRows(2) = -Eigen::Map<const RowMajor>(rows.data(), 2, p);
  derivative.resize(3 * std::size_t(p));
  Eigen::Map<RowMajor>(derivative.data(), 3, p) = by_x.partialPivLu().solve(by_camera);
  return true;
}

CameraPart camera_part(const Correspondences& c, const WorldNormalisation& normalisation,
                       const LensGradient& lens, const ProjectorState& state, const RobustLoss& loss,
                       const std::vector<double>& factor) {
  const int p = lens.parameter_count() + 6;
  const RowMajor full = Eigen::Map<const RowMajor>(factor.data(), p + 1, p + 1);
  const Eigen::MatrixXd r = full.topLeftCorner(p, p);
  const std::vector<Sums> sums = all_sums({c, normalisation, lens, state, loss}, terms_of(c));
  RowMajor total = RowMajor::Zero(p, p);
  CameraPart part;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const Eigen::Index q = sums[k].square.rows();
    if (q == 0) continue;
    const Eigen::Map<const RowMajor> covariance(c.cameras[k].covariance.data(), q, q);
    const Eigen::MatrixXd half = r.triangularView<Eigen::Upper>().transpose().solve(sums[k].cross);  // R⁻ᵀ·M
    const Eigen::MatrixXd g = -r.triangularView<Eigen::Upper>().solve(half);
    total += g * covariance * g.transpose();
    part.expected_chi2 += (covariance * (sums[k].square - half.transpose() * half)).trace();
  }
  total = ((total + total.transpose()) / 2).eval();
  part.covariance.assign(total.data(), total.data() + total.size());
  return part;
}

}  // namespace laterna
