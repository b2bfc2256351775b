// What an uncertain camera does to a projector that was solved for with its world points.
#pragma once

#include "calib/projection_rows.h"

#include <optional>
#include <vector>

namespace laterna {

/// ∂x/∂c, 3×p row-major (m per tangent unit of the camera, correspondences.h): the point x that a fixed
/// camera pixel sees, as the camera moves and the point slides on the tangent plane of normal n. By the
/// implicit function theorem, from pixel(x, c) = const and n·x = const:
///   [J_x; nᵀ]·∂x/∂c = -[J_c; 0],  J_x = ∂pixel/∂x (2×3), J_c = ∂pixel/∂c (2×p).
/// False where the point lies behind the camera, or the ray meets the plane at less than 1° (there a point
/// slides farther than any surface goes on as a plane).
bool point_by_camera(const LensGradient& lens, const ProjectorState& camera, const glm::dvec3& x_world,
                     const glm::dvec3& normal_world, std::vector<double>& derivative);

/// The cameras' share of a solution's covariance, and what their errors add to its residuals.
struct CameraPart {
  std::vector<double> covariance;  ///< row-major p×p, tangent order, the points' frame
  double expected_chi2 = 0;        ///< E[Σ(du² + dv²)/σ²] that remains once the projector has followed
};

/// To first order the estimate θ moves with a camera's parameters c by
///   G = ∂θ/∂c = -H⁻¹·Σ J_iᵀ·w_i·E_i,  E_i = ∂pixel_i/∂x·∂x_i/∂c,  H = Σ J_iᵀ·w_i·J_i,  w_i = ρ'/σ_i²
/// (implicit function theorem at the minimum, Gauss-Newton's H), so that C = Σ_cameras G·C_c·Gᵀ, and
/// expected_chi2 = Σ_cameras tr(C_c·(Σ E_iᵀ·w_i·E_i - (Σ J_iᵀ·w_i·E_i)ᵀ·H⁻¹·Σ J_iᵀ·w_i·E_i)).
/// `state` and `factor` = row_factor() in the normalised frame. Points whose derivative point_by_camera()
/// refuses count as fixed. Same bits for any number of threads.
CameraPart camera_part(const Correspondences& correspondences, const WorldNormalisation& normalisation,
                       const LensGradient& lens, const ProjectorState& state, const RobustLoss& loss,
                       const std::vector<double>& factor);

}  // namespace laterna
