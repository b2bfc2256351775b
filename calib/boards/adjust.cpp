#include "calib/boards/adjust.h"

#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace laterna {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using PoseManifold = ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>;
using PoseBlock = std::array<double, 7>;  // quaternion x, y, z, w; translation

PoseBlock block_of(const Rigid& rigid) {
  const glm::dquat q = glm::normalize(glm::quat_cast(rigid.rotation));
  const glm::dvec3& t = rigid.translation;
  return {q.x, q.y, q.z, q.w, t.x, t.y, t.z};
}

Rigid rigid_of(const double* b) {
  return rigid_from_quaternion(glm::dquat(b[3], b[0], b[1], b[2]), glm::dvec3(b[4], b[5], b[6]));
}

// The rig as Ceres holds it: for each device that is not held its free intrinsics and, but for device 0, its
// place; the bend; the poses.
struct Blocks {
  std::vector<std::vector<double>> intrinsics;
  std::vector<PoseBlock> places, poses;
  std::array<double, 2> bend{};
};

// A block among a pose's columns. Of a device: its intrinsics, or its place (ambient size 7, tangent 6).
struct Slot {
  enum class Kind { intrinsics, place, bend, board_pose } kind;
  int device;
  double* data;
  int size, column;
  bool is_pose() const { return kind == Kind::place || kind == Kind::board_pose; }
};

Blocks blocks_of(const RigProblem& problem, const Rig& rig) {
  Blocks b;
  for (std::size_t d = 0; d < rig.devices.size(); ++d) {
    const auto& columns = problem.columns.devices[d].intrinsics;
    std::vector<double> free;
    for (std::size_t i = 0; i < columns.size(); ++i)  // fx and fy may share a column
      if (columns[i] >= 0 && (i == 0 || columns[i] != columns[i - 1]))
        free.push_back(rig.devices[d].parameters[i]);
    b.intrinsics.push_back(std::move(free));
    b.places.push_back(block_of(rig.devices[d].device_from_camera));
  }
  for (const Rigid& pose : rig.camera_from_board) b.poses.push_back(block_of(pose));
  b.bend = {rig.bend.x, rig.bend.y};
  return b;
}

// The blocks of the global columns, in the columns' order.
std::vector<Slot> global_slots(const RigProblem& problem, Blocks& b) {
  std::vector<Slot> slots;
  for (std::size_t d = 0; d < b.intrinsics.size(); ++d) {
    const RigColumns::Of& of = problem.columns.devices[d];
    if (!b.intrinsics[d].empty())
      slots.push_back({Slot::Kind::intrinsics, int(d), b.intrinsics[d].data(), int(b.intrinsics[d].size()),
                       of.intrinsics[0]});
    if (of.pose >= 0) slots.push_back({Slot::Kind::place, int(d), b.places[d].data(), 6, of.pose});
  }
  if (problem.columns.bend >= 0)
    slots.push_back({Slot::Kind::bend, 0, b.bend.data(), 2, problem.columns.bend});
  return slots;
}

void write_rig(const RigProblem& problem, const std::vector<Slot>& slots, double const* const* values,
               Rig& rig) {
  for (std::size_t n = 0; n < slots.size(); ++n) {
    const Slot& slot = slots[n];
    RigDevice& device = rig.devices[slot.device];
    if (slot.kind == Slot::Kind::bend) rig.bend = {values[n][0], values[n][1]};
    if (slot.kind == Slot::Kind::place) device.device_from_camera = rigid_of(values[n]);
    if (slot.kind != Slot::Kind::intrinsics) continue;
    const std::vector<int>& columns = problem.columns.devices[slot.device].intrinsics;
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (columns[i] >= 0) device.parameters[i] = values[n][columns[i] - slot.column];
  }
}

// One pose's sightings as one residual block: the rows of its triangular factor, then what a robust loss
// adds.
class PoseResidual : public ceres::CostFunction {
 public:
  PoseResidual(const RigProblem& problem, const Rig& start, const std::vector<Slot>& slots, int pose)
      : problem_(problem), start_(start), slots_(slots), pose_(pose) {
    set_num_residuals(problem.row_columns() + 1);
    for (const Slot& slot : slots_)
      mutable_parameter_block_sizes()->push_back(slot.is_pose() ? 7 : slot.size);
    if (problem.pose_columns() > 0) mutable_parameter_block_sizes()->push_back(7);
  }

  bool Evaluate(double const* const* values, double* residuals, double** jacobians) const override {
    thread_local Rig rig;
    rig = start_;
    write_rig(problem_, slots_, values, rig);
    if (problem_.pose_columns() > 0) rig.camera_from_board[pose_] = rigid_of(values[slots_.size()]);
    const int n = problem_.row_columns();
    std::fill_n(residuals, n + 1, 0.0);
    const bool robust = problem_.loss.kind != RobustLoss::Kind::none;
    double loss = 0;
    if (!jacobians || robust) {
      const auto s = squared_residuals(problem_, rig, pose_);
      if (!s) return false;
      for (const double x : *s) loss += problem_.loss.rho(x);
    }
    if (!jacobians) {
      residuals[0] = std::sqrt(loss);
      return std::isfinite(loss);
    }
    const auto factor = pose_factor(problem_, rig, pose_);
    if (!factor) return false;
    const RowMajor r = Eigen::Map<const RowMajor>(factor->data(), n, n);
    Eigen::Map<Eigen::VectorXd>(residuals, n) = r.col(n - 1);
    if (robust) residuals[n] = std::sqrt(std::max(0.0, loss - r.col(n - 1).squaredNorm()));
    for (std::size_t b = 0; b < parameter_block_sizes().size(); ++b) {
      const bool own = b == slots_.size();
      const Slot slot =
          own ? Slot{Slot::Kind::board_pose, 0, nullptr, 6, -problem_.pose_columns()} : slots_[b];
      if (jacobians[b]) write_jacobian(r, slot, values[b], jacobians[b]);
    }
    return r.allFinite();
  }

 private:
  // Ceres asks for derivatives by the ambient quaternion and multiplies them by PlusJacobian; its tangent δ
  // is half the rotation vector. J_q = 2·J_w·MinusJacobian gives J_q·PlusJacobian = 2·J_w.
  void write_jacobian(const RowMajor& r, const Slot& slot, const double* value, double* out) const {
    const int n = problem_.row_columns(), at = problem_.pose_columns() + slot.column;
    RowMajor j = RowMajor::Zero(n + 1, slot.size);
    j.topRows(n - 1) = r.block(0, at, n - 1, slot.size);  // the last row of R holds the remainder alone
    if (!slot.is_pose()) {
      Eigen::Map<RowMajor>(out, n + 1, slot.size) = j;
      return;
    }
    Eigen::Matrix<double, 3, 4, Eigen::RowMajor> lift;
    ceres::EigenQuaternionManifold().MinusJacobian(value, lift.data());
    Eigen::Map<RowMajor> wide(out, n + 1, 7);
    wide.leftCols(4) = 2 * j.leftCols(3) * lift;
    wide.rightCols(3) = j.rightCols(3);
  }

  const RigProblem& problem_;
  const Rig& start_;
  const std::vector<Slot> slots_;
  const int pose_;
};

void build(ceres::Problem& ceres_problem, const RigProblem& problem, const Rig& start, Blocks& blocks) {
  const std::vector<Slot> slots = global_slots(problem, blocks);
  for (int k = 0; k < problem.pose_count(); ++k) {
    std::vector<double*> data;
    for (const Slot& slot : slots) data.push_back(slot.data);
    if (problem.pose_columns() > 0) data.push_back(blocks.poses[k].data());
    ceres_problem.AddResidualBlock(new PoseResidual(problem, start, slots, k), nullptr, data);
    if (problem.pose_columns() > 0) ceres_problem.SetManifold(blocks.poses[k].data(), new PoseManifold);
  }
  for (const Slot& slot : slots)
    if (slot.is_pose() && problem.pose_count() > 0) ceres_problem.SetManifold(slot.data, new PoseManifold);
}

ceres::Solver::Options solver_options(const RigProblem& problem, Blocks& blocks, int max_iterations) {
  ceres::Solver::Options o;
  o.max_num_iterations = max_iterations;
  o.function_tolerance = 1e-15;
  o.gradient_tolerance = 1e-16;
  o.parameter_tolerance = 1e-13;
  o.max_num_consecutive_invalid_steps = 50;
  o.initial_trust_region_radius = 1e6;
  o.max_trust_region_radius = 1e11;  // some damping always, or Cholesky of a weak problem fails
  o.num_threads = 1;
  o.logging_type = ceres::SILENT;
  o.linear_solver_type = ceres::DENSE_QR;
  if (problem.pose_columns() == 0 || problem.columns.count == 0) return o;
  o.linear_solver_type = ceres::DENSE_SCHUR;
  o.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (PoseBlock& pose : blocks.poses) o.linear_solver_ordering->AddElementToGroup(pose.data(), 0);
  for (const Slot& slot : global_slots(problem, blocks))
    o.linear_solver_ordering->AddElementToGroup(slot.data, 1);
  return o;
}

// Factors and loss at the end; false where something lies behind.
bool finish(const RigProblem& problem, Adjustment& result) {
  for (int k = 0; k < problem.pose_count(); ++k) {
    auto factor = pose_factor(problem, result.rig, k);
    const auto s = squared_residuals(problem, result.rig, k);
    if (!factor || !s) return false;
    result.pose_factors.push_back(std::move(*factor));
    for (const double x : *s) result.loss += problem.loss.rho(x);
  }
  return std::isfinite(result.loss);
}

}  // namespace

std::optional<Adjustment> adjust(const RigProblem& problem, const Rig& start, int max_iterations) {
  for (int k = 0; k < problem.pose_count(); ++k)
    if (!squared_residuals(problem, start, k)) return std::nullopt;
  Blocks blocks = blocks_of(problem, start);
  ceres::Problem ceres_problem;
  build(ceres_problem, problem, start, blocks);
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(problem, blocks, max_iterations), &ceres_problem, &summary);
  if (!summary.IsSolutionUsable()) return std::nullopt;

  Adjustment result;
  result.rig = start;
  const std::vector<Slot> slots = global_slots(problem, blocks);
  std::vector<const double*> values;
  for (const Slot& slot : slots) values.push_back(slot.data);
  write_rig(problem, slots, values.data(), result.rig);
  for (int k = 0; k < problem.pose_count() && problem.pose_columns() > 0; ++k)
    result.rig.camera_from_board[k] = rigid_of(blocks.poses[k].data());
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.iterations = int(summary.iterations.size()) - 1;
  result.termination = summary.message;
  if (!finish(problem, result)) return std::nullopt;
  return result;
}

}  // namespace laterna
