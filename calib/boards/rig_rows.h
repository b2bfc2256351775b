// Residuals and Jacobian rows of a rig, pose by pose: what adjustment, held-out error and covariance are made
// of.
#pragma once

#include "calib/boards/rig.h"
#include "calib/robust_loss.h"
#include "calib/stacked_qr.h"
#include "sim/lens.h"

#include <optional>
#include <vector>

namespace laterna {

/// Sightings sorted by pose, lens models with gradients and columns: everything that stays while a rig is
/// solved for.
struct RigProblem {
  /// Throws InputError where the capture is invalid, or where the model does not fit it.
  RigProblem(const BoardCapture& capture, const RigModel& model, const RobustLoss& loss = {});

  RigModel model;
  RigColumns columns;
  RobustLoss loss;
  BoardExtent extent;
  std::vector<Sighting> sightings;      ///< sorted by pose, otherwise in the capture's order
  std::vector<std::size_t> pose_begin;  ///< pose k has the sightings [begin[k], begin[k + 1])
  std::vector<LensGradient> lenses;     ///< one per device

  int pose_count() const { return int(pose_begin.size()) - 1; }
  /// 6, or 0 where the poses are held.
  int pose_columns() const { return model.hold_poses ? 0 : 6; }
  /// Columns of a pose's rows: its own, the global ones, the residual.
  int row_columns() const { return pose_columns() + columns.count + 1; }
};

/// Adds to the six columns of a rigid motion x_target = R·x + t (left rotation vector, translation) the
/// derivative that a gradient g by x_target makes: dx = w × R·x + dt. `rotated` is R·x.
void add_pose_row(double* row, const glm::dvec3& rotated, const glm::dvec3& g);

/// The pixel of one sighting under a rig (where it was `read_at` a camera's sighting, less slope·(the
/// camera's pixel under the rig - the one seen)) and, unless null, its two rows of derivatives by the pose's
/// columns and the global ones (row-major 2×(row_columns() - 1)). False where the point lies behind the
/// device.
bool predict(const RigProblem& problem, const BoardRig& rig, const Sighting& sighting, double pixel[2],
             double* rows);

/// s = (du² + dv²)/σ² of each of a pose's sightings. None where a point lies behind its device.
std::optional<std::vector<double>> squared_residuals(const RigProblem& problem, const BoardRig& rig,
                                                     int pose);

/// Rows [J_global r] of the priors of free intrinsics, r = (k - mean)/sigma, row-major with columns.count + 1
/// columns; empty where there are none.
std::vector<double> prior_rows(const RigProblem& problem, const BoardRig& rig);

/// The triangular factor (stacked_qr.h) of a pose's rows [J_pose J_global r]·√ρ'(s)/σ, r = predicted -
/// measured. Its lower right corner, below the pose's columns, is the factor with the pose eliminated
/// (Schur). None where a point lies behind its device.
std::optional<std::vector<double>> pose_factor(const RigProblem& problem, const BoardRig& rig, int pose);

}  // namespace laterna
