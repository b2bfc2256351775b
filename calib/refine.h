// One maximum-likelihood refinement by Ceres from one start.
#pragma once

#include "calib/projection_rows.h"

#include <optional>
#include <string>
#include <vector>

namespace laterna {

struct RefineOptions {
  RobustLoss loss;
  int max_iterations = 500;
  double pixel_scale =
      1000;  ///< fx, fy, cx, cy are solved for in this unit, so that all parameters are near 1
};

struct Refinement {
  ProjectorState state;
  double loss = 0;  ///< Σ ρ(s) at `state`
  bool converged = false;
  int iterations = 0;
  std::string termination;     ///< in words; Ceres's own, unless the next step is too small to matter
  std::vector<double> factor;  ///< R of the rows [J | r] at `state` (projection_rows.h), row-major
};

/// Minimises ½ Σ ρ(s) over fx, fy, cx, cy, the lens and the pose, until the next Gauss-Newton step δ is below
/// 1e-6 standard deviations (δᵀ·JᵀJ·δ < 1e-12), or to Ceres's convergence at tolerances near rounding. Ceres
/// sees one residual block that holds the triangular factor [R z; 0 ρ] of all rows: the same cost, gradient
/// and normal equations. A trial step that puts a point behind the device is shortened. None where the start
/// itself has a point behind, or something is not finite.
std::optional<Refinement> refine(const PointTable& points, const LensGradient& lens,
                                 const ProjectorState& start, const RefineOptions& options);

/// (JᵀJ)⁻¹ of the tangent parameters by ceres::Covariance (DENSE_SVD) on the same block, row-major p×p, in
/// the points' frame. None where Ceres finds it rank-deficient. `factor`: row_factor() at `state` where it is
/// at hand, else empty.
std::optional<std::vector<double>> ceres_covariance(const PointTable& points, const LensGradient& lens,
                                                    const ProjectorState& state, const RefineOptions& options,
                                                    std::vector<double> factor = {});

}  // namespace laterna
