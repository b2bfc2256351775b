#include "calib/boards/rig_rows.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

void validate(const RigModel& model, const BoardCapture& capture) {
  if (model.devices.size() != capture.devices.size()) {
    throw InputError(fmt::format("rig: found {} device models, expected {} as in the capture",
                                 model.devices.size(), capture.devices.size()));
  }
  for (const DeviceModel& m : model.devices) {
    const int expected = lens_parameter_count(m.lens_model);
    if (int(m.lens_free.size()) != expected) {
      throw InputError(fmt::format("rig: {} has {} flags of free parameters, expected {}", m.lens_model,
                                   m.lens_free.size(), expected));
    }
    if (!m.prior.empty() && int(m.prior.mean.size()) != 4 + expected) {
      throw InputError(fmt::format("rig: {} has a prior of {} parameters, expected {}", m.lens_model,
                                   m.prior.mean.size(), 4 + expected));
    }
  }
}

}  // namespace

RigProblem::RigProblem(const BoardCapture& capture, const RigModel& rig_model, const RobustLoss& robust_loss)
    : model(rig_model),
      columns(columns_of(rig_model)),
      loss(robust_loss),
      extent(capture.extent),
      sightings(capture.sightings) {
  laterna::validate(capture);
  validate(model, capture);
  std::stable_sort(sightings.begin(), sightings.end(),
                   [](const Sighting& a, const Sighting& b) { return a.pose < b.pose; });
  pose_begin.assign(capture.pose_labels.size() + 1, 0);
  for (const Sighting& s : sightings) ++pose_begin[s.pose + 1];
  for (std::size_t k = 1; k < pose_begin.size(); ++k) pose_begin[k] += pose_begin[k - 1];
  for (const DeviceModel& m : model.devices) lenses.emplace_back(m.lens_model);
}

void add_pose_row(double* row, const glm::dvec3& rotated, const glm::dvec3& g) {
  const glm::dvec3 turn = glm::cross(rotated, g);
  for (int i = 0; i < 3; ++i) row[i] += turn[i], row[3 + i] += g[i];
}

namespace {

// Where the rig alone puts a sighting.
bool project(const RigProblem& problem, const BoardRig& rig, const Sighting& s, double pixel[2],
             double* rows) {
  const RigDevice& device = rig.devices[s.device];
  const RigColumns::Of& of = problem.columns.devices[s.device];
  const Rigid& board = rig.camera_from_board[s.pose];
  const glm::dvec3 on_board = board.rotation * bent(s.x_board, problem.extent, rig.bend);
  const glm::dvec3 x_camera = on_board + board.translation;
  const glm::dvec3 turned = device.device_from_camera.rotation * x_camera;
  thread_local std::vector<double> dk;
  const int k = problem.lenses[s.device].parameter_count();
  dk.resize(2 * std::size_t(k));
  double dx[6];
  if (!problem.lenses[s.device].project(device.parameters, turned + device.device_from_camera.translation,
                                        pixel, rows ? dx : nullptr, rows ? dk.data() : nullptr))
    return false;
  if (!rows) return true;

  const int count = problem.row_columns() - 1, global = problem.pose_columns();
  std::fill_n(rows, 2 * count, 0.0);
  const glm::dvec2 shape = bend_shape(s.x_board, problem.extent);
  for (int r = 0; r < 2; ++r) {
    double* row = rows + r * count;
    const glm::dvec3 g(dx[3 * r], dx[3 * r + 1], dx[3 * r + 2]);
    const glm::dvec3 g_camera = g * device.device_from_camera.rotation;  // a row times a matrix
    if (global > 0) add_pose_row(row, on_board, g_camera);
    for (int i = 0; i < k; ++i)
      if (of.intrinsics[i] >= 0) row[global + of.intrinsics[i]] += dk[r * k + i];
    if (of.pose >= 0) add_pose_row(row + global + of.pose, turned, g);
    for (int i = 0; i < 2 && problem.columns.bend >= 0; ++i)
      row[global + problem.columns.bend + i] = shape[i] * glm::dot(g_camera, board.rotation[2]);
  }
  return true;
}

}  // namespace

bool predict(const RigProblem& problem, const BoardRig& rig, const Sighting& s, double pixel[2],
             double* rows) {
  if (!project(problem, rig, s, pixel, rows)) return false;
  if (!s.read_at) return true;
  const std::size_t count = std::size_t(problem.row_columns() - 1);
  thread_local std::vector<double> seen_rows;
  seen_rows.resize(2 * count);
  Sighting seen = s;
  seen.device = s.read_at->device;
  double at[2];
  if (!project(problem, rig, seen, at, rows ? seen_rows.data() : nullptr)) return false;
  const glm::dmat2& slope = s.read_at->slope;
  const glm::dvec2 moved = slope * (glm::dvec2(at[0], at[1]) - s.read_at->pixel);
  for (int r = 0; r < 2; ++r) {
    pixel[r] -= moved[r];
    for (std::size_t j = 0; rows && j < count; ++j)
      rows[r * count + j] -= slope[0][r] * seen_rows[j] + slope[1][r] * seen_rows[count + j];
  }
  return true;
}

std::optional<std::vector<double>> squared_residuals(const RigProblem& problem, const BoardRig& rig,
                                                     int pose) {
  std::vector<double> s;
  double pixel[2];
  for (std::size_t i = problem.pose_begin[pose]; i < problem.pose_begin[pose + 1]; ++i) {
    const Sighting& sighting = problem.sightings[i];
    if (!predict(problem, rig, sighting, pixel, nullptr)) return std::nullopt;
    const double du = pixel[0] - sighting.pixel.x, dv = pixel[1] - sighting.pixel.y;
    s.push_back((du * du + dv * dv) / (sighting.sigma_px * sighting.sigma_px));
  }
  return s;
}

std::vector<double> prior_rows(const RigProblem& problem, const BoardRig& rig) {
  const std::size_t columns = std::size_t(problem.columns.count) + 1;
  std::vector<double> rows;
  for (std::size_t d = 0; d < rig.devices.size(); ++d) {
    const IntrinsicsPrior& prior = problem.model.devices[d].prior;
    for (std::size_t i = 0; i < prior.mean.size(); ++i) {
      const int column = problem.columns.devices[d].intrinsics[i];
      if (column < 0) continue;
      rows.resize(rows.size() + columns, 0.0);
      rows[rows.size() - columns + std::size_t(column)] = prior.inverse_sigma[i];
      rows.back() = prior.residual(i, rig.devices[d].parameters[i]);
    }
  }
  return rows;
}

std::optional<std::vector<double>> pose_factor(const RigProblem& problem, const BoardRig& rig, int pose) {
  const std::size_t first = problem.pose_begin[pose];
  StackedRows stacked;
  stacked.items = problem.pose_begin[pose + 1] - first;
  stacked.columns = problem.row_columns();
  const int count = stacked.columns - 1;
  stacked.fill = [&](std::size_t begin, std::size_t end, const RowBlock& block) {
    std::vector<double> rows(2 * std::size_t(count));
    double pixel[2];
    for (std::size_t i = begin; i < end; ++i) {
      const Sighting& sighting = problem.sightings[first + i];
      if (!predict(problem, rig, sighting, pixel, rows.data())) return false;
      const double du = pixel[0] - sighting.pixel.x, dv = pixel[1] - sighting.pixel.y;
      const double is = 1 / sighting.sigma_px;
      const double w = is * std::sqrt(problem.loss.weight(is * is * (du * du + dv * dv)));
      for (int j = 0; j < count; ++j)
        block.column(j, 0)[i - begin] = w * rows[j], block.column(j, 1)[i - begin] = w * rows[count + j];
      block.column(count, 0)[i - begin] = w * du, block.column(count, 1)[i - begin] = w * dv;
    }
    return true;
  };
  return triangular_factor(stacked);
}

}  // namespace laterna
