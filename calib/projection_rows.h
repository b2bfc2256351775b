// Residuals and Jacobian rows of all correspondences under one projector: what every solver and covariance
// here is made of.
//
// Tangent order of the p columns: fx, fy, cx, cy (px), lens parameters, rotation (3), translation (3). The
// rotation is a small left rotation vector w in the device frame, in radians: R = exp([w]×)·R̂.
#pragma once

#include "calib/correspondences.h"
#include "calib/intrinsics_prior.h"
#include "calib/robust_loss.h"
#include "calib/stacked_qr.h"
#include "sim/device.h"
#include "sim/large_vector.h"

#include <optional>
#include <span>
#include <vector>

namespace laterna {

/// x_normalised = (x_world - center)/scale: centroid at the origin, mean distance from it 1.
struct WorldNormalisation {
  glm::dvec3 center{0.0};
  double scale_m = 1;
};
WorldNormalisation normalisation_of(std::span<const glm::dvec3> world_points);

/// x_device/scale = R·x_normalised + t_n with t_n = (t + R·center)/scale; a projection is blind to the scale.
Rigid device_from_normalised(const Rigid& device_from_world, const WorldNormalisation& normalisation);
/// The inverse: t = scale·t_n - R·center.
Rigid device_from_world(const Rigid& device_from_normalised, const WorldNormalisation& normalisation);

/// A projector while it is being solved for.
struct ProjectorState {
  std::vector<double> parameters;  ///< fx, fy, cx, cy, lens parameters
  Rigid device_from_points;        ///< the points' frame is world, or the normalised one
};
ProjectorState state_of(const Device& device);

/// Correspondences as columns, in normalised coordinates, sorted by cluster (stable).
struct PointTable {
  LargeVector<double> x, y, z, u, v, inverse_sigma;
  IntrinsicsPrior prior;  ///< rows of row_factor() and terms of total_loss() beside the points'
  std::vector<std::size_t> cluster_begin;  ///< cluster g holds the points [begin[g], begin[g + 1])
  std::size_t size() const { return x.size(); }
  std::size_t cluster_count() const { return cluster_begin.size() - 1; }
};
PointTable point_table(const Correspondences& correspondences, const WorldNormalisation& normalisation);

/// The pixel of one point and its 2×p tangent rows (row-major; may be null). False where the point lies
/// behind.
bool project_with_rows(const LensGradient& lens, const ProjectorState& state, const glm::dvec3& x,
                       double pixel[2], double* rows);

/// Writes, for the points [begin, end), the rows [J | r]·√ρ'(s)/σ, r = projected - measured: p + 1 columns.
/// False where a point lies behind the device.
bool fill_rows(const PointTable& points, const LensGradient& lens, const ProjectorState& state,
               const RobustLoss& loss, std::size_t begin, std::size_t end, const RowBlock& block);

/// R of all rows [J | r] (stacked_qr.h), the prior's (k - mean)/sigma among them, (p + 1)×(p + 1). None where
/// a point lies behind the device.
std::optional<std::vector<double>> row_factor(const PointTable& points, const LensGradient& lens,
                                              const ProjectorState& state, const RobustLoss& loss);

/// s = (du² + dv²)/σ² of each point, in the table's order. None where a point lies behind the device.
std::optional<LargeVector<double>> squared_residuals(const PointTable& points, const LensGradient& lens,
                                                     const ProjectorState& state);

/// Σ ρ(s), summed in a fixed order, and Σ ((k - mean)/sigma)² of the prior. None where a point lies behind
/// the device.
std::optional<double> total_loss(const PointTable& points, const LensGradient& lens,
                                 const ProjectorState& state, const RobustLoss& loss);

}  // namespace laterna
