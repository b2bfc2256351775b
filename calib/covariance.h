// What the residuals say about the parameters: two covariances, and the directions that the data cannot tell.
#pragma once

#include "calib/projection_rows.h"

#include <optional>
#include <string>
#include <vector>

namespace laterna {

/// The delete-one-cluster jackknife, one Gauss-Newton step each (CR3; Bell and McCaffrey 2002; Hansen 2022):
///   C = (G-1)/G · Σ_g d_g·d_gᵀ,  d_g = (H - H_g)⁻¹·g_g,  H = JᵀJ, H_g and g_g = J_gᵀ·r_g of cluster g alone.
/// Right whatever the correlation inside a cluster, as long as clusters are many (3·p or more) and
/// independent. Row-major p×p, tangent order, the points' frame. `factor`: row_factor() at `state`, of full
/// rank. None where a cluster cannot be left out: the others do not determine the projector. With a robust
/// loss H is the true second derivative, ρ'·JᵀJ + 2ρ''·(Jᵀr)(Jᵀr)ᵀ; for H_g its first term stands. A prior is
/// of no cluster: its rows B add H⁻¹·BᵀB·H⁻¹, as if its means had errors of its sigmas.
std::optional<std::vector<double>> clustered_covariance(const PointTable& points, const LensGradient& lens,
                                                        const ProjectorState& state, const RobustLoss& loss,
                                                        const std::vector<double>& factor);

/// From normalised points to world points: t = scale·t_n - R·center, so δt = scale·δt_n + (R·center) × w.
std::vector<double> world_covariance(const std::vector<double>& covariance_normalised,
                                     const Rigid& device_from_world, const WorldNormalisation& normalisation);

/// The Jacobian with its columns scaled to length 1.
struct Spectrum {
  std::vector<double> singular_values;  ///< largest first
  std::vector<double> weakest;          ///< the right singular vector of the smallest, p entries
};
Spectrum scaled_spectrum(const std::vector<double>& factor, int parameter_count);

/// fx, fy, cx, cy, lens0..., rotation_x.., translation_x..: tangent order.
std::vector<std::string> parameter_names(int lens_parameters);

/// "fx, fy and translation_z trade off": the parameters that dominate a direction.
std::string direction_in_words(const std::vector<double>& direction, const std::vector<std::string>& names);

}  // namespace laterna
