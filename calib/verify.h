// How far an estimated projector is from the true one, in projector pixels, and how far noise alone would put
// it.
#pragma once

#include "sim/device.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace laterna {

/// Errors over a set of world points: e = estimate's pixel - true pixel.
struct ErrorSummary {
  double rms = 0;            ///< sqrt(mean(du² + dv²)), projector pixels; infinite where `failed` > 0
  double max = 0;            ///< largest |e|
  std::size_t points = 0;    ///< points that the true projector maps
  double predicted_rms = 0;  ///< sqrt(mean(trace(J·C·Jᵀ))) at the same points; NaN without a covariance
  std::size_t failed = 0;    ///< of them, those that the estimate cannot project
};

struct Verification {
  ErrorSummary surface;        ///< the surface points themselves
  ErrorSummary volume;         ///< whole projector image × 5-95 % of the surface points' depths
  ErrorSummary extrapolation;  ///< whole projector image × 0.8·nearest..5 % and 95 %..1.25·farthest
};

/// Depths, in metres along the axis, of a list of lit depths (not empty): 12 evenly from the 5th to the 95th
/// percentile; 6 evenly from 0.8·nearest to the 5th percentile (exclusive) and 6 from the 95th (exclusive) to
/// 1.25·farthest. Percentiles by linear interpolation between order statistics.
std::vector<double> volume_depths(std::vector<double> lit_depths_m);
std::vector<double> extrapolation_depths(std::vector<double> lit_depths_m);

/// World points on 16×12 pixels × the given depths: pixel positions evenly from edge to edge, u from -0.5 to
/// W-0.5 and v from -0.5 to H-0.5. Pixels that the device's lens maps nowhere give no points.
std::vector<glm::dvec3> image_grid(const Device& device, const std::vector<double>& depths_m);

/// Axial depths of the points that a device has in front of it.
std::vector<double> depths_of(const Device& device, std::span<const glm::dvec3> world_points);

/// du, dv of each point: estimate - truth; NaN where either cannot project it.
std::vector<glm::dvec2> error_vectors(const Device& truth, const Device& estimate,
                                      std::span<const glm::dvec3> world_points);

/// sqrt(mean(trace(J·C·Jᵀ))) over the points that the device projects. `covariance`: row-major p×p, tangent
/// order fx, fy, cx, cy, lens, rotation (left, device frame, rad), translation (m); world frame. None where
/// no point can be projected.
std::optional<double> predicted_rms(const Device& device, const std::vector<double>& covariance,
                                    std::span<const glm::dvec3> world_points);

/// The three sets of DESIGN.md, laid out by the true device; `covariance` may be empty. Throws InputError
/// where no surface point lies in front of the true device, the images differ in size, or the covariance has
/// another size than the estimate's parameters. A point that the estimate cannot project is counted and makes
/// rms and max infinite.
Verification verify(const Device& truth, const Device& estimate, const std::vector<double>& covariance,
                    std::span<const glm::dvec3> surface_points);

}  // namespace laterna
