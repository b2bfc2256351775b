// The joint adjustment: all devices, all board poses and the bend of the board in one bundle, by Ceres.
#pragma once

#include "calib/boards/rig_rows.h"

#include <optional>
#include <string>
#include <vector>

namespace laterna {

struct Adjustment {
  BoardRig rig;
  double loss = 0;  ///< Σ ρ(s) at `rig`, and the priors' ((k - mean)/sigma)²
  bool converged = false;
  int iterations = 0;
  std::string termination;                        ///< Ceres's own words
  std::vector<std::vector<double>> pose_factors;  ///< pose_factor() of each pose at `rig`
};

/// Minimises ½ Σ ρ(s), and ½ ((k - mean)/sigma)² of the priors, over everything that the problem's model
/// frees, until Ceres finds convergence near rounding, or `max_iterations` are spent in a valley whose last
/// fifty steps took less than 1e-4 off the loss. Ceres sees one residual block per pose that holds the
/// triangular factor of the pose's rows (the same cost, gradient and normal equations), and eliminates the
/// poses (Schur). None where the start has a point behind a device, or something is not finite.
std::optional<Adjustment> adjust(const RigProblem& problem, const BoardRig& start, int max_iterations = 500);

}  // namespace laterna
