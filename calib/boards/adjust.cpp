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

// A block among a pose's columns. Of a device: its intrinsics, or its place (ambient size 7, tangent 6).
struct Slot {
  enum class Kind { intrinsics, place, bend, board_pose } kind;
  int device;
  double* data;
  int size, column;
  bool is_pose() const { return kind == Kind::place || kind == Kind::board_pose; }
};

// The rig as Ceres holds it, in one piece: Ceres orders blocks by address, and the order must not change.
struct Blocks {
  std::vector<double> values;
  std::vector<Slot> global;    // for each device its free intrinsics and its place; the bend
  std::vector<double*> poses;  // empty where they are held

  template <class Values>
  double* append(const Values& added) {
    values.insert(values.end(), added.begin(), added.end());
    return values.data() + (values.size() - added.size());
  }
};

std::vector<double> free_intrinsics(const std::vector<int>& columns, const std::vector<double>& parameters) {
  std::vector<double> free;
  for (std::size_t i = 0; i < columns.size(); ++i)  // fx and fy may share a column
    if (columns[i] >= 0 && (i == 0 || columns[i] != columns[i - 1])) free.push_back(parameters[i]);
  return free;
}

void fill(Blocks& b, const RigProblem& problem, const BoardRig& rig) {
  b.values.reserve(std::size_t(problem.columns.count) + rig.devices.size() +
                   7 * rig.camera_from_board.size());  // so that nothing moves
  for (int d = 0; d < int(rig.devices.size()); ++d) {
    const RigColumns::Of& of = problem.columns.devices[d];
    const std::vector<double> free = free_intrinsics(of.intrinsics, rig.devices[d].parameters);
    if (!free.empty()) {
      const int first =
          *std::find_if(of.intrinsics.begin(), of.intrinsics.end(), [](int c) { return c >= 0; });
      b.global.push_back({Slot::Kind::intrinsics, d, b.append(free), int(free.size()), first});
    }
    if (of.pose < 0) continue;
    double* place = b.append(block_of(rig.devices[d].device_from_camera));
    b.global.push_back({Slot::Kind::place, d, place, 6, of.pose});
  }
  if (problem.columns.bend >= 0) {
    double* bend = b.append(std::array<double, 2>{rig.bend.x, rig.bend.y});
    b.global.push_back({Slot::Kind::bend, 0, bend, 2, problem.columns.bend});
  }
  for (const Rigid& pose : rig.camera_from_board)
    if (problem.pose_columns() > 0) b.poses.push_back(b.append(block_of(pose)));
}

void write_rig(const RigProblem& problem, const std::vector<Slot>& slots, double const* const* values,
               BoardRig& rig) {
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
  PoseResidual(const RigProblem& problem, const BoardRig& start, const std::vector<Slot>& slots, int pose)
      : problem_(problem), start_(start), slots_(slots), pose_(pose) {
    set_num_residuals(problem.row_columns() + 1);
    for (const Slot& slot : slots_)
      mutable_parameter_block_sizes()->push_back(slot.is_pose() ? 7 : slot.size);
    if (problem.pose_columns() > 0) mutable_parameter_block_sizes()->push_back(7);
  }

  bool Evaluate(double const* const* values, double* residuals, double** jacobians) const override {
    BoardRig rig = start_;
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
  const BoardRig& start_;
  const std::vector<Slot> slots_;
  const int pose_;
};

// (k - mean)/sigma of one device's free intrinsics.
class PriorResidual : public ceres::CostFunction {
 public:
  PriorResidual(const IntrinsicsPrior& prior, const std::vector<int>& columns, const Slot& slot)
      : prior_(prior), size_(slot.size) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (columns[i] >= 0) terms_.push_back({i, columns[i] - slot.column});
    set_num_residuals(int(terms_.size()));
    mutable_parameter_block_sizes()->push_back(size_);
  }

  bool Evaluate(double const* const* values, double* residuals, double** jacobians) const override {
    const bool rows = jacobians && jacobians[0];
    if (rows) std::fill_n(jacobians[0], terms_.size() * std::size_t(size_), 0.0);
    for (std::size_t n = 0; n < terms_.size(); ++n) {
      const auto& [parameter, at] = terms_[n];
      residuals[n] = prior_.residual(parameter, values[0][at]);
      if (rows) jacobians[0][n * std::size_t(size_) + std::size_t(at)] = prior_.inverse_sigma[parameter];
    }
    return true;
  }

 private:
  struct Term {
    std::size_t parameter;
    int at;
  };
  const IntrinsicsPrior& prior_;
  const int size_;
  std::vector<Term> terms_;
};

void build(ceres::Problem& ceres_problem, const RigProblem& problem, const BoardRig& start,
           const Blocks& blocks) {
  for (int k = 0; k < problem.pose_count(); ++k) {
    std::vector<double*> data;
    for (const Slot& slot : blocks.global) data.push_back(slot.data);
    if (!blocks.poses.empty()) data.push_back(blocks.poses[k]);
    ceres_problem.AddResidualBlock(new PoseResidual(problem, start, blocks.global, k), nullptr, data);
    if (!blocks.poses.empty()) ceres_problem.SetManifold(blocks.poses[k], new PoseManifold);
  }
  for (const Slot& slot : blocks.global) {
    if (slot.is_pose() && problem.pose_count() > 0) ceres_problem.SetManifold(slot.data, new PoseManifold);
    if (slot.kind != Slot::Kind::intrinsics || problem.model.devices[slot.device].prior.empty()) continue;
    ceres_problem.AddResidualBlock(new PriorResidual(problem.model.devices[slot.device].prior,
                                                     problem.columns.devices[slot.device].intrinsics, slot),
                                   nullptr, slot.data);
  }
}

ceres::Solver::Options solver_options(const Blocks& blocks, int max_iterations) {
  ceres::Solver::Options o;
  o.max_num_iterations = max_iterations;
  o.function_tolerance = 1e-12;  // some 1e-5 sigma from the minimum; less is rounding of the cost
  o.gradient_tolerance = 1e-16;
  o.parameter_tolerance = 1e-13;
  o.max_num_consecutive_invalid_steps = 50;
  o.initial_trust_region_radius = 1e6;
  o.max_trust_region_radius = 1e8;  // some damping always, or Cholesky of a weak problem fails
  o.num_threads = 1;
  o.logging_type = ceres::SILENT;
  o.linear_solver_type = ceres::DENSE_QR;
  if (blocks.poses.empty() || blocks.global.empty()) return o;
  o.linear_solver_type = ceres::DENSE_SCHUR;
  o.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (double* pose : blocks.poses) o.linear_solver_ordering->AddElementToGroup(pose, 0);
  for (const Slot& slot : blocks.global) o.linear_solver_ordering->AddElementToGroup(slot.data, 1);
  return o;
}

// Iterations are spent, but the last fifty took less than 1e-4 off the loss, some 0.1 of a thousand
// residuals' χ²: a valley so flat that where in it one stops is well within the sigmas, which say how long it
// is.
bool in_a_flat_valley(const ceres::Solver::Summary& summary) {
  constexpr std::size_t last = 50;
  if (summary.termination_type != ceres::NO_CONVERGENCE || summary.iterations.size() <= last) return false;
  const double before = summary.iterations[summary.iterations.size() - 1 - last].cost,
               now = summary.final_cost;
  return before - now < 1e-4 * now;
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
  const std::vector<double> priors = prior_rows(problem, result.rig);
  const std::size_t columns = std::size_t(problem.columns.count) + 1;
  for (std::size_t last = columns - 1; last < priors.size(); last += columns)
    result.loss += priors[last] * priors[last];
  return std::isfinite(result.loss);
}

}  // namespace

std::optional<Adjustment> adjust(const RigProblem& problem, const BoardRig& start, int max_iterations) {
  for (int k = 0; k < problem.pose_count(); ++k)
    if (!squared_residuals(problem, start, k)) return std::nullopt;
  Blocks blocks;
  fill(blocks, problem, start);
  ceres::Problem ceres_problem;
  build(ceres_problem, problem, start, blocks);
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(blocks, max_iterations), &ceres_problem, &summary);
  if (!summary.IsSolutionUsable()) return std::nullopt;

  Adjustment result;
  result.rig = start;
  std::vector<const double*> values;
  for (const Slot& slot : blocks.global) values.push_back(slot.data);
  write_rig(problem, blocks.global, values.data(), result.rig);
  for (std::size_t k = 0; k < blocks.poses.size(); ++k)
    result.rig.camera_from_board[k] = rigid_of(blocks.poses[k]);
  result.converged = summary.termination_type == ceres::CONVERGENCE || in_a_flat_valley(summary);
  result.iterations = int(summary.iterations.size()) - 1;
  result.termination = summary.message;
  if (!finish(problem, result)) return std::nullopt;
  return result;
}

}  // namespace laterna
