#include "calib/refine.h"

#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// The parameters as Ceres holds them: intrinsics in units of pixel_scale then lens; quaternion x, y, z, w;
// translation.
struct Blocks {
  std::vector<double> intrinsics;
  std::array<double, 4> quaternion_xyzw{};
  std::array<double, 3> translation{};
};

Blocks blocks_of(const ProjectorState& state, double pixel_scale) {
  Blocks b{state.parameters, {}, {}};
  for (int i = 0; i < 4; ++i) b.intrinsics[i] /= pixel_scale;
  const glm::dquat q = glm::normalize(glm::quat_cast(state.device_from_points.rotation));
  b.quaternion_xyzw = {q.x, q.y, q.z, q.w};
  for (int i = 0; i < 3; ++i) b.translation[i] = state.device_from_points.translation[i];
  return b;
}

ProjectorState state_of_blocks(const double* intrinsics, std::size_t count, const double* q, const double* t,
                               double pixel_scale) {
  ProjectorState state{{intrinsics, intrinsics + count}, {}};
  for (int i = 0; i < 4; ++i) state.parameters[i] *= pixel_scale;
  state.device_from_points =
      rigid_from_quaternion(glm::dquat(q[3], q[0], q[1], q[2]), glm::dvec3(t[0], t[1], t[2]));
  return state;
}

// What all rows amount to at one place.
struct Evaluation {
  ProjectorState state;
  std::vector<double> factor;
  double loss = 0;
};

bool same(const ProjectorState& a, const ProjectorState& b) {
  return a.parameters == b.parameters && a.device_from_points.rotation == b.device_from_points.rotation &&
         a.device_from_points.translation == b.device_from_points.translation;
}

// All points as one residual block: p residuals z, then |remainder|, then what a robust loss adds.
class StackedBlock : public ceres::CostFunction {
 public:
  StackedBlock(const PointTable& points, const LensGradient& lens, const RefineOptions& options)
      : points_(points), lens_(lens), options_(options), p_(lens.parameter_count() + 6) {
    set_num_residuals(p_ + 2);
    *mutable_parameter_block_sizes() = {lens.parameter_count(), 4, 3};
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const ProjectorState state = state_of_blocks(parameters[0], lens_.parameter_count(), parameters[1],
                                                 parameters[2], options_.pixel_scale);
    if (!jacobians) return cost_only(state, residuals);
    if (!evaluate(state)) return false;
    const RowMajor r = Eigen::Map<const RowMajor>(last_.factor.data(), p_ + 1, p_ + 1);
    Eigen::Map<Eigen::VectorXd>(residuals, p_ + 1) = r.col(p_);
    residuals[p_ + 1] = std::sqrt(std::max(0.0, last_.loss - r.col(p_).squaredNorm()));
    if (options_.loss.kind == RobustLoss::Kind::none) residuals[p_ + 1] = 0;
    write_jacobians(r, parameters[1], jacobians);
    return r.allFinite();
  }

  // With a factor at hand this is evaluated there, and nowhere else.
  void keep(std::vector<double> factor) { given_ = std::move(factor); }

  // The last place where derivatives were asked for; none where there was none.
  const Evaluation& last() const { return last_; }

  // Length of the Gauss-Newton step from there in standard deviations: δ = -R⁻¹·z, so δᵀ·RᵀR·δ = |z|².
  double next_step_sigmas() const {
    if (last_.factor.empty()) return INFINITY;
    return Eigen::Map<const RowMajor>(last_.factor.data(), p_ + 1, p_ + 1).col(p_).head(p_).norm();
  }

 private:
  bool evaluate(const ProjectorState& state) const {
    auto factor = given_.empty() ? row_factor(points_, lens_, state, options_.loss) : std::optional(given_);
    if (!factor) return false;
    double loss = Eigen::Map<const RowMajor>(factor->data(), p_ + 1, p_ + 1).col(p_).squaredNorm();
    if (options_.loss.kind != RobustLoss::Kind::none) {
      const auto total = total_loss(points_, lens_, state, options_.loss);
      if (!total) return false;
      loss = *total;
    }
    last_ = {state, std::move(*factor), loss};
    return true;
  }

  bool cost_only(const ProjectorState& state, double* residuals) const {
    const auto loss = total_loss(points_, lens_, state, options_.loss);
    if (!loss) return false;
    std::fill_n(residuals, p_ + 2, 0.0);
    residuals[0] = std::sqrt(*loss);
    return true;
  }

  // Ceres asks for derivatives by the ambient quaternion and multiplies them by PlusJacobian; its tangent δ
  // is half the rotation vector. J_q = 2·J_w·MinusJacobian gives J_q·PlusJacobian = 2·J_w.
  void write_jacobians(const RowMajor& r, const double* quaternion, double** jacobians) const {
    const int k = lens_.parameter_count();
    RowMajor j = RowMajor::Zero(p_ + 2, p_);
    j.topRows(p_) = r.topLeftCorner(p_, p_);
    if (jacobians[0]) {
      Eigen::Map<RowMajor> out(jacobians[0], p_ + 2, k);
      out = j.leftCols(k);
      out.leftCols(4) *= options_.pixel_scale;
    }
    if (jacobians[1]) {
      Eigen::Matrix<double, 3, 4, Eigen::RowMajor> lift;
      ceres::EigenQuaternionManifold().MinusJacobian(quaternion, lift.data());
      Eigen::Map<RowMajor>(jacobians[1], p_ + 2, 4) = 2 * j.middleCols(k, 3) * lift;
    }
    if (jacobians[2]) Eigen::Map<RowMajor>(jacobians[2], p_ + 2, 3) = j.rightCols(3);
  }

  const PointTable& points_;
  const LensGradient& lens_;
  const RefineOptions& options_;
  const int p_;
  std::vector<double> given_;
  mutable Evaluation last_;  // Ceres evaluates on one thread
};

constexpr double negligible_step_sigmas = 1e-6;

// Ends the iterations where the next step would not matter.
class StepWatch : public ceres::IterationCallback {
 public:
  explicit StepWatch(const StackedBlock& block) : block_(block) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return block_.next_step_sigmas() < negligible_step_sigmas ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                                                              : ceres::SOLVER_CONTINUE;
  }

 private:
  const StackedBlock& block_;
};

StackedBlock& build(ceres::Problem& problem, const PointTable& points, const LensGradient& lens,
                    const RefineOptions& options, Blocks& blocks) {
  double *k = blocks.intrinsics.data(), *q = blocks.quaternion_xyzw.data(), *t = blocks.translation.data();
  auto* block = new StackedBlock(points, lens, options);  // the problem's from here on
  problem.AddResidualBlock(block, nullptr, k, q, t);
  problem.SetManifold(q, new ceres::EigenQuaternionManifold);
  return *block;
}

ceres::Solver::Options solver_options(int max_iterations) {
  ceres::Solver::Options o;
  o.linear_solver_type = ceres::DENSE_QR;
  o.max_num_iterations = max_iterations;
  o.function_tolerance = 1e-16;
  o.gradient_tolerance = 1e-16;
  o.parameter_tolerance = 1e-14;
  o.max_num_consecutive_invalid_steps = 50;
  o.initial_trust_region_radius = 1e10;  // the starts are good: nearly Gauss-Newton from the first step
  o.num_threads = 1;                     // the block has its own
  o.logging_type = ceres::SILENT;
  return o;
}

}  // namespace

std::optional<Refinement> refine(const PointTable& points, const LensGradient& lens,
                                 const ProjectorState& start, const RefineOptions& options) {
  if (!total_loss(points, lens, start, options.loss)) return std::nullopt;
  Blocks blocks = blocks_of(start, options.pixel_scale);
  ceres::Problem problem;
  const StackedBlock& block = build(problem, points, lens, options, blocks);
  StepWatch watch(block);
  ceres::Solver::Options how = solver_options(options.max_iterations);
  how.callbacks.push_back(&watch);
  ceres::Solver::Summary summary;
  ceres::Solve(how, &problem, &summary);
  if (!summary.IsSolutionUsable()) return std::nullopt;

  Refinement result;
  result.state =
      state_of_blocks(blocks.intrinsics.data(), blocks.intrinsics.size(), blocks.quaternion_xyzw.data(),
                      blocks.translation.data(), options.pixel_scale);
  if (same(block.last().state, result.state)) {
    result.factor = block.last().factor;
    result.loss = block.last().loss;
  } else {
    const auto factor = row_factor(points, lens, result.state, options.loss);
    const auto loss = total_loss(points, lens, result.state, options.loss);
    if (!factor || !loss) return std::nullopt;
    result.factor = *factor;
    result.loss = *loss;
  }
  const bool no_step_left = summary.termination_type == ceres::USER_SUCCESS;
  result.converged = no_step_left || summary.termination_type == ceres::CONVERGENCE;
  result.iterations = int(summary.iterations.size()) - 1;
  result.termination =
      no_step_left ? "Convergence. The next step is below 1e-6 standard deviations." : summary.message;
  return result;
}

std::optional<std::vector<double>> ceres_covariance(const PointTable& points, const LensGradient& lens,
                                                    const ProjectorState& state, const RefineOptions& options,
                                                    std::vector<double> factor) {
  const int k = lens.parameter_count(), p = k + 6;
  Blocks blocks = blocks_of(state, options.pixel_scale);
  ceres::Problem problem;
  build(problem, points, lens, options, blocks).keep(std::move(factor));
  ceres::Covariance::Options o;
  o.algorithm_type = ceres::DENSE_SVD;
  o.min_reciprocal_condition_number = 1e-26;  // of JᵀJ
  o.num_threads = 1;
  ceres::Covariance covariance(o);
  const std::vector<const double*> order = {blocks.intrinsics.data(), blocks.quaternion_xyzw.data(),
                                            blocks.translation.data()};
  RowMajor c(p, p);
  if (!covariance.Compute(order, &problem) || !covariance.GetCovarianceMatrixInTangentSpace(order, c.data()))
    return std::nullopt;
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(p);
  unit.head(4).setConstant(options.pixel_scale);
  unit.segment(k, 3).setConstant(2);  // w = 2δ
  c = unit.asDiagonal() * c * unit.asDiagonal();
  if (!c.allFinite()) return std::nullopt;
  return std::vector<double>(c.data(), c.data() + c.size());
}

}  // namespace laterna
