#include "calib/boards/board_diagnosis.h"

#include "calib/covariance.h"
#include "calib/verify.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace laterna {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

PoseDiagnosis diagnose_pose(const RigProblem& problem, const RigFit& fit, int pose) {
  const BoardRig& rig = fit.adjustment.rig;
  const std::size_t devices = rig.devices.size();
  PoseDiagnosis d;
  d.label = fit.capture.pose_labels[pose];
  d.sightings.assign(devices, 0), d.fit_rms_px.assign(devices, 0.0);
  const auto squared = squared_residuals(problem, rig, pose).value_or(std::vector<double>{});
  for (std::size_t i = 0; i < squared.size(); ++i) {
    const Sighting& s = problem.sightings[problem.pose_begin[pose] + i];
    ++d.sightings[s.device];
    d.fit_rms_px[s.device] += squared[i] * s.sigma_px * s.sigma_px;
  }
  for (std::size_t n = 0; n < devices; ++n)
    d.fit_rms_px[n] = std::sqrt(d.fit_rms_px[n] / std::max(1.0, double(d.sightings[n])));
  const Rigid& board = rig.camera_from_board[pose];
  d.distance = glm::length(apply(board, {problem.extent.center, 0.0}));
  d.tilt_deg = degrees(std::acos(std::min(1.0, std::abs(board.rotation[2].z))));
  return d;
}

// Axial depths of a device's sightings.
std::vector<double> depths_of_sightings(const RigFit& fit, int device) {
  const BoardRig& rig = fit.adjustment.rig;
  std::vector<double> depths;
  for (const Sighting& s : fit.capture.sightings) {
    if (s.device != device) continue;
    const glm::dvec3 x_camera = apply(rig.camera_from_board[s.pose], s.x_board);
    depths.push_back(apply(rig.devices[device].device_from_camera, x_camera).z);
  }
  return depths;
}

// Points in the device's own frame.
std::vector<glm::dvec3> device_grid(const RigFit& fit, int device, const std::vector<double>& depths) {
  Device own = device_of(fit.adjustment.rig, fit.model, fit.capture, device);
  own.device_from_world = Rigid{};
  return image_grid(own, depths);
}

double coverage(const BoardCapture& capture, int device) {
  constexpr int columns = 8, rows = 6;
  std::vector<char> cell(columns * rows, 0);
  const glm::dvec2 size(capture.devices[device].size);
  for (const Sighting& s : capture.sightings) {
    if (s.device != device) continue;
    const glm::dvec2 at = (s.pixel + 0.5) / size;
    const int i = std::clamp(int(at.x * columns), 0, columns - 1);
    cell[std::clamp(int(at.y * rows), 0, rows - 1) * columns + i] = 1;
  }
  return double(std::count(cell.begin(), cell.end(), 1)) / (columns * rows);
}

// rms of sqrt(trace) over points; NaN without points. `predict` is pixel_covariance() or its like.
RangeSigma sigma_over(const RigProblem& problem, const RigFit& fit, const RigCovariance& covariance,
                      int device, const std::vector<glm::dvec3>& points,
                      decltype(pixel_covariance)& predict = pixel_covariance) {
  RangeSigma r;
  double sum = 0, count = 0;
  for (const glm::dvec3& x : points) {
    const auto c = predict(problem, fit.adjustment.rig, covariance, device, x);
    if (!c) continue;
    sum += c->x + c->z, ++count;
    r.worst_px = std::max(r.worst_px, std::sqrt(c->x + c->z));
  }
  r.rms_px = std::sqrt(sum / count);
  return r;
}

DeviceDiagnosis diagnose_device(const RigProblem& problem, const RigFit& fit, const RigCovariance& covariance,
                                int device) {
  DeviceDiagnosis d;
  d.coverage = coverage(fit.capture, device);
  std::vector<double> depths = depths_of_sightings(fit, device);
  if (depths.empty()) return d;
  std::sort(depths.begin(), depths.end());
  const Device own = device_of(fit.adjustment.rig, fit.model, fit.capture, device);
  const LensProjection lens(own.intrinsics, own.lens);
  const glm::dvec2 middle = (glm::dvec2(own.intrinsics.size) - 1.0) / 2.0;
  for (const double range :
       {depths.front(), depths[depths.size() / 2], depths.back(), 1000 * depths.back()}) {
    RangeSigma r = sigma_over(problem, fit, covariance, device, device_grid(fit, device, {range}));
    r.range = range;
    if (const auto ray = lens.unproject(middle))
      r.center_px = sigma_over(problem, fit, covariance, device, {*ray * range}).rms_px;
    d.ranges.push_back(r);
  }
  return d;
}

// How far a rig with some of the poses puts the points of a device elsewhere, rms; none where it cannot.
std::optional<double> distance_px(const RigProblem& problem, const BoardRig& from, const BoardRig& to,
                                  const std::vector<int>& poses, int device,
                                  const std::vector<glm::dvec3>& points) {
  const LensGradient& lens = problem.lenses[device];
  double sum = 0;
  for (const glm::dvec3& x : points) {
    const auto there = carried_pixel(lens, from, to, poses, device, x);
    const auto here = carried_pixel(lens, from, from, {0}, device, x);
    if (!there || !here) return std::nullopt;
    sum += glm::dot(*there - *here, *there - *here);
  }
  return std::sqrt(sum / double(std::max<std::size_t>(1, points.size())));
}

// The same for a rig without one pose.
std::optional<double> leverage(const RigProblem& problem, const RigFit& fit, const HeldOutPose& fold,
                               int device, const std::vector<glm::dvec3>& points) {
  std::vector<int> poses;
  for (int k = 0; k < fit.capture.pose_count(); ++k)
    if (k != fold.pose) poses.push_back(k);
  return distance_px(problem, fit.adjustment.rig, fold.rig, poses, device, points);
}

// Those whose volumes count; the last device where all are cameras.
std::vector<int> projectors_of(const BoardCapture& capture) {
  std::vector<int> projectors;
  for (int n = 0; n < int(capture.devices.size()); ++n)
    if (!is_camera(capture, n)) projectors.push_back(n);
  if (projectors.empty()) projectors.push_back(int(capture.devices.size()) - 1);
  return projectors;
}

std::vector<glm::dvec3> volume_of(const RigFit& fit, int device) {
  return device_grid(fit, device, volume_depths(depths_of_sightings(fit, device)));
}

// A NaN stays.
void raise_to(double value, double& most) {
  if (!(value <= most) && !std::isnan(most)) most = value;
}

// The errors over one projector's volume: a diagnosis holds the greatest of all projectors.
void diagnose_volume(const RigProblem& problem, const RigFit& fit, const RigCovariance& covariance,
                     const HeldOut& held_out, int device, Diagnosis& d) {
  const std::vector<glm::dvec3> volume = volume_of(fit, device);
  d.maps_its_volume = d.maps_its_volume && volume.size() == std::size_t(16 * 12 * 12);
  raise_to(sigma_over(problem, fit, covariance, device, volume).rms_px, d.predicted_volume_rms_px);
  raise_to(sigma_over(problem, fit, covariance, device, volume, pixel_covariance_in_camera).rms_px,
           d.predicted_volume_camera_frame_rms_px);
  double sum = 0;
  for (const HeldOutPose& fold : held_out.folds) {
    const double moved = leverage(problem, fit, fold, device, volume).value_or(INFINITY);
    std::optional<double>& most = d.poses[fold.pose].leverage_px;
    most = std::max(most.value_or(0), moved);
    sum += moved * moved;
  }
  const double poses = fit.capture.pose_count();
  if (!held_out.failed.empty() || poses < 3 || !std::isfinite(sum)) return;
  d.jackknife_volume_rms_px =
      std::max(d.jackknife_volume_rms_px.value_or(0), std::sqrt(sum * (poses - 1) / poses));
}

std::vector<std::string> strongest_correlations(const RigFit& fit, const RigCovariance& c) {
  const auto names = column_names(fit.model, fit.capture);
  struct Pair {
    double value;
    int i, j;
  };
  std::vector<Pair> pairs;
  for (int i = 0; i < c.globals; ++i) {
    for (int j = i + 1; j < c.globals; ++j) {
      const double rho =
          c.global[i * c.globals + j] / std::sqrt(c.global[i * c.globals + i] * c.global[j * c.globals + j]);
      if (std::abs(rho) > 0.95) pairs.push_back({rho, i, j});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return std::abs(a.value) > std::abs(b.value); });
  std::vector<std::string> words;
  for (const Pair& p : pairs) {
    if (words.size() == 3) break;
    words.push_back(fmt::format("{} and {} correlate {:.3f}", names[p.i], names[p.j], p.value));
  }
  return words;
}

// The size of each lens parameter that moves some sighting by as many pixels as the focal length has.
void add_lens_units(const RigProblem& problem, const BoardRig& rig, std::vector<double>& unit) {
  std::vector<double> rows(2 * std::size_t(problem.row_columns() - 1));
  std::vector<double> most(unit.size(), 0.0);
  for (const Sighting& s : problem.sightings) {
    double pixel[2];
    if (!predict(problem, rig, s, pixel, rows.data())) continue;
    const auto& columns = problem.columns.devices[s.device].intrinsics;
    for (std::size_t i = 4; i < columns.size(); ++i) {
      if (columns[i] < 0) continue;
      const int at = problem.pose_columns() + columns[i];
      most[columns[i]] = std::max(most[columns[i]], std::hypot(rows[at], rows[rows.size() / 2 + at]));
      if (most[columns[i]] > 0) unit[columns[i]] = rig.devices[s.device].parameters[0] / most[columns[i]];
    }
  }
}

// The size of a natural step of each global parameter.
std::vector<double> natural_units(const RigFit& fit) {
  const RigProblem problem(fit.capture, fit.model);
  const RigColumns& columns = problem.columns;
  std::vector<double> unit(columns.count, 1.0);
  double distance = 0;
  const BoardRig& rig = fit.adjustment.rig;
  for (const Rigid& pose : rig.camera_from_board)
    distance += glm::length(apply(pose, {fit.capture.extent.center, 0.0})) / fit.capture.pose_count();
  for (std::size_t d = 0; d < rig.devices.size(); ++d) {
    const RigColumns::Of& of = columns.devices[d];
    for (int i = 0; i < 4; ++i)
      if (of.intrinsics[i] >= 0) unit[of.intrinsics[i]] = rig.devices[d].parameters[0];
    for (int i = 3; i < 6 && of.pose >= 0; ++i) unit[of.pose + i] = distance;
  }
  for (int i = 0; i < 2 && columns.bend >= 0; ++i)
    unit[columns.bend + i] = std::max(fit.capture.extent.half_size.x, fit.capture.extent.half_size.y);
  add_lens_units(problem, rig, unit);
  return unit;
}

}  // namespace

WeakestDirection weakest_direction(const RigFit& fit, const std::vector<double>& factor) {
  const int g = columns_of(fit.model).count;
  if (g == 0) return {};
  RowMajor r = Eigen::Map<const RowMajor>(factor.data(), g + 1, g + 1).topLeftCorner(g, g);
  const std::vector<double> unit = natural_units(fit);
  for (int j = 0; j < g; ++j) r.col(j) *= unit[j];
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(r, Eigen::ComputeFullV);
  const Eigen::VectorXd weakest = svd.matrixV().col(g - 1);
  const auto s = scaled_spectrum(factor, g).singular_values;
  return {1 / svd.singularValues()[g - 1],
          direction_in_words({weakest.data(), weakest.data() + g}, column_names(fit.model, fit.capture)),
          s.back() / s.front()};
}

std::optional<double> volume_distance_px(const RigFit& fit, const BoardRig& other) {
  std::vector<int> poses(other.camera_from_board.size());
  std::iota(poses.begin(), poses.end(), 0);
  const RigProblem problem(fit.capture, fit.model);
  double most = 0;
  for (const int n : projectors_of(fit.capture)) {
    const auto moved = distance_px(problem, fit.adjustment.rig, other, poses, n, volume_of(fit, n));
    if (!moved) return std::nullopt;
    most = std::max(most, *moved);
  }
  return most;
}

Diagnosis diagnose(const RigFit& fit, const RigCovariance& covariance, const HeldOut& held_out) {
  const RigProblem problem(fit.capture, fit.model);
  const BoardRig& rig = fit.adjustment.rig;
  Diagnosis d;
  for (int k = 0; k < fit.capture.pose_count(); ++k) {
    d.poses.push_back(diagnose_pose(problem, fit, k));
    for (int l = 0; l < k; ++l)
      d.tilt_spread_deg = std::max(
          d.tilt_spread_deg,
          degrees(angle_between(rig.camera_from_board[k].rotation[2], rig.camera_from_board[l].rotation[2])));
  }
  for (int n = 0; n < int(rig.devices.size()); ++n)
    d.devices.push_back(diagnose_device(problem, fit, covariance, n));
  for (const int n : projectors_of(fit.capture)) diagnose_volume(problem, fit, covariance, held_out, n, d);
  const WeakestDirection weakest = weakest_direction(fit, covariance.factor);
  d.weakest_sigma = weakest.sigma;
  d.weakest_direction = weakest.words;
  d.smallest_gap = weakest.smallest_gap;
  d.correlations = strongest_correlations(fit, covariance);
  return d;
}

std::string cure_for(const std::string& direction) {
  const auto names = [&](const char* word) { return direction.find(word) != std::string::npos; };
  if (names("bend")) return "add poses in which the board is rolled by 90°, and close ones";
  if (names(" k") || names(" p1") || names(" p2") || names(" s") || names("lens"))
    return "add poses in which corners reach the edges and corners of each image";
  if (names(" fx") || names(" fy") || names("translation"))
    return "add poses tilted by 30° or more, some about the vertical and some about the horizontal axis, and "
           "at other distances";
  return "add poses tilted about both axes and rolled by 90°, near and far";
}

}  // namespace laterna
