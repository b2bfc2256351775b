// Point clouds as PLY: what meshing and alignment tools read.
#pragma once

#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace laterna {

struct CloudPoint {
  glm::dvec3 x_world{0.0};       ///< metres
  glm::dvec2 projector_px{0.0};  ///< which projector pixel lights it; integer coordinates at pixel centres
  glm::dvec2 camera_px{0.0};     ///< which camera pixel sees it
};

/// A binary little-endian PLY file of element `vertex` alone: x, y, z as doubles (metres, the world's axes),
/// projector_u, projector_v, camera_u, camera_v as floats.
std::string point_cloud_ply(const std::vector<CloudPoint>& points);

}  // namespace laterna
