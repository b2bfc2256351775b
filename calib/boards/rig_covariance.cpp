#include "calib/boards/rig_covariance.h"

#include "calib/covariance.h"

#include <Eigen/Dense>
#include <algorithm>

namespace laterna {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Map = Eigen::Map<const RowMajor>;

std::vector<double> values_of(const RowMajor& m) { return {m.data(), m.data() + m.size()}; }

Map square(const std::vector<double>& values, int size) { return {values.data(), size, size}; }

// False where a pose's own columns are rank-deficient.
bool append_pose(const std::vector<double>& factor, int globals, RigCovariance& c) {
  const RowMajor r = square(factor, 6 + globals + 1);
  const auto own = r.topLeftCorner(6, 6).triangularView<Eigen::Upper>();
  const double largest = r.diagonal().head(6).cwiseAbs().maxCoeff();
  if (!(r.diagonal().head(6).cwiseAbs().minCoeff() > 1e-14 * largest)) return false;
  const RowMajor inverse = own.solve(RowMajor::Identity(6, 6));
  c.pose_own.push_back(values_of(inverse * inverse.transpose()));
  c.pose_from_global.push_back(values_of(-inverse * r.block(0, 6, 6, globals)));
  return true;
}

}  // namespace

std::vector<double> eliminated_factor(const RigProblem& problem, const Adjustment& adjustment) {
  const int n = problem.columns.count + 1, skip = problem.pose_columns();
  const auto poses = Eigen::Index(adjustment.pose_factors.size());
  const std::vector<double> prior = prior_rows(problem, adjustment.rig);
  const Eigen::Index priors = Eigen::Index(prior.size()) / n;
  RowMajor rows = RowMajor::Zero(std::max<Eigen::Index>(poses * n + priors, n), n);
  for (Eigen::Index k = 0; k < poses; ++k)
    rows.middleRows(k * n, n) = square(adjustment.pose_factors[k], skip + n).bottomRightCorner(n, n);
  rows.middleRows(poses * n, priors) = Map(prior.data(), priors, n);
  const Eigen::HouseholderQR<RowMajor> qr(rows);
  const RowMajor r = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  return values_of(r);
}

std::optional<RigCovariance> rig_covariance(const RigProblem& problem, const Adjustment& adjustment) {
  RigCovariance c;
  c.globals = problem.columns.count;
  c.factor = eliminated_factor(problem, adjustment);
  if (c.globals > 0) {
    const std::vector<double> s = scaled_spectrum(c.factor, c.globals).singular_values;
    if (!(s.back() > 1e-10 * s.front())) return std::nullopt;
  }
  const RowMajor r = square(c.factor, c.globals + 1).topLeftCorner(c.globals, c.globals);
  const RowMajor inverse = r.triangularView<Eigen::Upper>().solve(RowMajor::Identity(c.globals, c.globals));
  c.global = values_of(inverse * inverse.transpose());
  for (const auto& factor : adjustment.pose_factors) {
    if (problem.pose_columns() > 0 && !append_pose(factor, c.globals, c)) return std::nullopt;
  }
  return c;
}

std::vector<double> full_covariance(const RigCovariance& c) {
  const int g = c.globals, poses = int(c.pose_own.size()), size = g + 6 * poses;
  RowMajor spread = RowMajor::Zero(size, g), full = RowMajor::Zero(size, size);
  spread.topRows(g) = RowMajor::Identity(g, g);
  for (int k = 0; k < poses; ++k) {
    spread.middleRows(g + 6 * k, 6) = Map(c.pose_from_global[k].data(), 6, g);
    full.block(g + 6 * k, g + 6 * k, 6, 6) = square(c.pose_own[k], 6);
  }
  full += spread * square(c.global, g) * spread.transpose();
  return values_of(full);
}

namespace {

// Of the pixel of a point: by x_device, and by the global parameters where the point is fixed in the camera's
// frame.
struct PixelRows {
  glm::dvec3 by_point[2];
  RowMajor by_globals;
};

std::optional<PixelRows> pixel_rows(const RigProblem& problem, const BoardRig& rig, int globals, int device,
                                    const glm::dvec3& x_device) {
  const RigDevice& d = rig.devices[device];
  const RigColumns::Of& of = problem.columns.devices[device];
  const int k = problem.lenses[device].parameter_count();
  double pixel[2], dx[6];
  std::vector<double> dk(2 * std::size_t(k));
  if (!problem.lenses[device].project(d.parameters, x_device, pixel, dx, dk.data())) return std::nullopt;
  PixelRows rows{{}, RowMajor::Zero(2, globals)};
  for (int r = 0; r < 2; ++r) {
    rows.by_point[r] = {dx[3 * r], dx[3 * r + 1], dx[3 * r + 2]};
    for (int i = 0; i < k; ++i)
      if (of.intrinsics[i] >= 0) rows.by_globals(r, of.intrinsics[i]) += dk[r * k + i];
    if (of.pose >= 0)
      add_pose_row(&rows.by_globals(r, of.pose), x_device - d.device_from_camera.translation,
                   rows.by_point[r]);
  }
  return rows;
}

glm::dvec3 upper_of(const Eigen::Matrix2d& m) { return {m(0, 0), m(0, 1), m(1, 1)}; }

}  // namespace

std::optional<glm::dvec3> pixel_covariance_in_camera(const RigProblem& problem, const BoardRig& rig,
                                                     const RigCovariance& c, int device,
                                                     const glm::dvec3& x_device) {
  const auto rows = pixel_rows(problem, rig, c.globals, device, x_device);
  if (!rows) return std::nullopt;
  return upper_of(rows->by_globals * square(c.global, c.globals) * rows->by_globals.transpose());
}

std::optional<glm::dvec3> pixel_covariance(const RigProblem& problem, const BoardRig& rig,
                                           const RigCovariance& c, int device, const glm::dvec3& x_device) {
  const auto rows = pixel_rows(problem, rig, c.globals, device, x_device);
  if (!rows) return std::nullopt;
  const RigDevice& d = rig.devices[device];
  const glm::dvec3 x_camera = apply(inverse(d.device_from_camera), x_device);
  RowMajor global = rows->by_globals;
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  const double share = 1.0 / std::max<double>(1, double(c.pose_own.size()));
  for (std::size_t n = 0; n < c.pose_own.size(); ++n) {
    RowMajor own = RowMajor::Zero(2, 6);
    for (int r = 0; r < 2; ++r)
      add_pose_row(&own(r, 0), x_camera - rig.camera_from_board[n].translation,
                   share * (rows->by_point[r] * d.device_from_camera.rotation));
    global += own * Map(c.pose_from_global[n].data(), 6, c.globals);
    sum += own * square(c.pose_own[n], 6) * own.transpose();
  }
  sum += global * square(c.global, c.globals) * global.transpose();
  return upper_of(sum);
}

std::optional<glm::dvec2> carried_pixel(const LensGradient& lens, const BoardRig& from, const BoardRig& to,
                                        const std::vector<int>& poses, int device,
                                        const glm::dvec3& x_device) {
  const glm::dvec3 x_camera = apply(inverse(from.devices[device].device_from_camera), x_device);
  glm::dvec3 mean(0.0);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const glm::dvec3 x_board = apply(inverse(from.camera_from_board[poses[i]]), x_camera);
    mean += apply(to.camera_from_board[i], x_board) / double(poses.size());
  }
  double pixel[2];
  if (!lens.project(to.devices[device].parameters, apply(to.devices[device].device_from_camera, mean), pixel,
                    nullptr, nullptr))
    return std::nullopt;
  return glm::dvec2(pixel[0], pixel[1]);
}

}  // namespace laterna
