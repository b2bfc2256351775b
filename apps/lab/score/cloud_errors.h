// How far the points of a cloud are from where they should be, by the scene's own surface and devices.
#pragma once

#include "calib/similarity.h"
#include "render/surface_query.h"
#include "sim/device.h"
#include "sim/formats/point_cloud.h"

#include <glm/glm.hpp>

#include <optional>
#include <span>
#include <vector>

namespace laterna {

/// What clouds are held against.
struct CloudGround {
  const SurfaceQuery* surface = nullptr;
  std::optional<Device> camera{}, projector{};  ///< whose pixels the cloud has; none: it has none
  double farthest_m = 0;  ///< no error counts as larger: the diagonal of the box around meshes and devices
};

/// One number per point; of what the cloud has no pixels for: empty.
struct CloudErrors {
  /// From the point to the nearest point of any triangle, whichever side and whether or not it is seen.
  std::vector<double> surface_m{};
  std::vector<double> point_m{};  ///< from the point to the true point of its pixel; NaN where there is none
  std::vector<double> projector_px{};  ///< from the point's projection by the true projector to its pixel
};

/// The first point of the surface on the ray of each point's camera pixel or, without these, its projector
/// pixel; NaN where the ray meets nothing or the pixel is outside the image. Empty where the cloud has no
/// pixels.
std::vector<glm::dvec3> true_points(const CloudGround& ground, std::span<const CloudPoint> points);

/// `true_points` of them. Errors are no larger than ground.farthest_m, and the projector's diagonal, which
/// also stands for a point that it cannot project.
CloudErrors cloud_errors(const CloudGround& ground, std::span<const CloudPoint> points,
                         std::span<const glm::dvec3> true_points);

/// world_from_cloud of fit_similarity over the points that have a true point (of at most 20,000, evenly
/// spread).
std::optional<Similarity> aligned_to(std::span<const CloudPoint> points,
                                     std::span<const glm::dvec3> true_points,
                                     const SimilarityOptions& options);

/// sqrt(mean e²) and the value that a share of all numbers does not exceed, NaN left out; NaN of none.
double rms_of(std::span<const double> errors);
double quantile_of(std::span<const double> errors, double share);

}  // namespace laterna
