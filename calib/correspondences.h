// What decoding hands to solving: world point ↔ projector pixel, each with its standard deviation.
#pragma once

#include "sim/device.h"
#include "sim/large_vector.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace laterna {

/// A camera whose pixels' rays gave world points, as it is believed to be, and how far it may be off.
struct UncertainCamera {
  Device device;
  /// Of fx, fy, cx, cy, lens, rotation (small left rotation vector in the device frame, rad) and translation
  /// (m), row-major p×p, world frame. Empty: certain.
  std::vector<double> covariance;
};

/// World points (metres) and the projector pixels that light them (integer coordinates are pixel centres).
struct Correspondences {
  LargeVector<glm::dvec3> world_points;
  LargeVector<glm::dvec2> projector_pixels;
  LargeVector<double> sigma_px;  ///< per coordinate: u and v each have this standard deviation
  /// The block of the camera image that a point was seen in; errors inside a block may be correlated. Ids
  /// need not be dense. Empty: every point is a block of its own.
  LargeVector<std::uint32_t> cluster;
  /// With uncertain cameras: each point's camera, an index into `cameras`, and the unit normal (either sense)
  /// of the surface that the camera's ray met there. All three empty: the world points are certain.
  std::vector<UncertainCamera> cameras{};
  LargeVector<std::uint32_t> camera{};
  LargeVector<glm::dvec3> normals_world{};
};

/// Throws InputError, naming the first offending index, where the lengths differ, a number is not finite, a
/// sigma is not positive, a normal is no unit vector, or a camera's index or covariance is unsound.
void validate(const Correspondences& correspondences);

/// The correspondences with the given indices, in that order.
Correspondences subset(const Correspondences& correspondences, const std::vector<std::size_t>& indices);

/// `wanted` of the indices 0..count-1 (all of them where there are fewer), evenly spread and jittered by the
/// golden ratio, so that no row or column of a raster is met again and again.
std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t wanted);

}  // namespace laterna
