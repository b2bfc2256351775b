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
    const auto factor = row_factor(points_, lens_, state, options_.loss);
    if (!factor) return false;
    const RowMajor r = Eigen::Map<const RowMajor>(factor->data(), p_ + 1, p_ + 1);
    Eigen::Map<Eigen::VectorXd>(residuals, p_ + 1) = r.col(p_);
    residuals[p_ + 1] = 0;
    if (options_.loss.kind != RobustLoss::Kind::none) {
      const auto loss = total_loss(points_, lens_, state, options_.loss);
      if (!loss) return false;
      residuals[p_ + 1] = std::sqrt(std::max(0.0, *loss - r.col(p_).squaredNorm()));
    }
    write_jacobians(r, parameters[1], jacobians);
    return r.allFinite();
  }

 private:
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
};

void build(ceres::Problem& problem, const PointTable& points, const LensGradient& lens,
           const RefineOptions& options, Blocks& blocks) {
  double *k = blocks.intrinsics.data(), *q = blocks.quaternion_xyzw.data(), *t = blocks.translation.data();
  problem.AddResidualBlock(new StackedBlock(points, lens, options), nullptr, k, q, t);
  problem.SetManifold(q, new ceres::EigenQuaternionManifold);
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
  build(problem, points, lens, options, blocks);
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(options.max_iterations), &problem, &summary);
  if (!summary.IsSolutionUsable()) return std::nullopt;

  Refinement result;
  result.state =
      state_of_blocks(blocks.intrinsics.data(), blocks.intrinsics.size(), blocks.quaternion_xyzw.data(),
                      blocks.translation.data(), options.pixel_scale);
  const auto factor = row_factor(points, lens, result.state, options.loss);
  const auto loss = total_loss(points, lens, result.state, options.loss);
  if (!factor || !loss) return std::nullopt;
  result.factor = *factor;
  result.loss = *loss;
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.iterations = int(summary.iterations.size()) - 1;
  result.termination = summary.message;
  return result;
}

std::optional<std::vector<double>> ceres_covariance(const PointTable& points, const LensGradient& lens,
                                                    const ProjectorState& state,
                                                    const RefineOptions& options) {
  const int k = lens.parameter_count(), p = k + 6;
  Blocks blocks = blocks_of(state, options.pixel_scale);
  ceres::Problem problem;
  build(problem, points, lens, options, blocks);
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
