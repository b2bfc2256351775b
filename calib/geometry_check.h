// What can be said before solving: do these points determine a projector at all?
#pragma once

#include "calib/correspondences.h"
#include "sim/rigid.h"

#include <string>

namespace laterna {

enum class Geometry { sound, too_few, identical, collinear, coplanar, pixels_collinear };

struct GeometryReport {
  Geometry verdict = Geometry::sound;
  std::string reason;  ///< one sentence; empty where sound
  /// Standard deviations of the world points along their principal axes in metres, largest first.
  glm::dvec3 spread_m{0.0};
  glm::dvec3 thin_axis_world{0.0, 0.0, 1.0};  ///< unit vector of the smallest spread
};

/// Refuses fewer than max(6, parameter_count/2) different points (a placement alone, 6 parameters: 4, and
/// coplanar ones pass); points whose second (collinear) or third (coplanar) spread is at most 1e-9 of the
/// first, or lost in the rounding of far coordinates (8 ulp of the largest); pixels that are all the same or
/// on one line (second spread at most 1e-9 of the first). Thin relief passes: it shows in the predicted
/// error. The correspondences must be valid.
GeometryReport check_geometry(const Correspondences& correspondences, int parameter_count);

/// Thickness over throw: the peak-to-peak extent of the points along their thin axis over their centroid's
/// distance from the device.
double relief_over_throw(const Correspondences& correspondences, const GeometryReport& report,
                         const Rigid& device_from_world);

}  // namespace laterna
