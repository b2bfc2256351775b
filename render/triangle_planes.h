// The plane of every triangle of an object, in double: what refines a hit that was found in single precision.
#pragma once

#include "sim/scene.h"

#include <glm/glm.hpp>

#include <vector>

namespace laterna {

/// One triangle, 64 bytes. All zero where it is degenerate.
struct TrianglePlane {
  glm::dvec3 normal_object;  ///< unit, towards the front side, in the object's frame
  double distance;           ///< normal_object·(x - center_object) for the points x of the plane
  glm::dvec3 normal_world;  ///< unit, towards the front side: the front side moves with the object, also when
                            ///< world_from_object mirrors it
  double margin_m;          ///< how far a shadow ray starts above it; see RayScene
};

/// An object ready for rays.
struct ObjectPlanes {
  glm::dmat4 world_from_object;
  glm::dmat3 object_from_world_linear;  ///< the inverse of the left 3×3 block
  glm::dvec3 center_object;             ///< of the bounding box; planes are relative to it, for precision
  std::vector<TrianglePlane> planes;
};

/// `scene_center_world` and `margin_factor`: margin_m is margin_factor·2⁻²⁴ times the largest coordinate of
/// the triangle's vertices relative to the scene's centre, that is, margin_factor half-steps of single
/// precision. Throws InputError, naming the object, where a coordinate is not finite, an index is out of
/// range, or world_from_object is singular.
ObjectPlanes make_planes(const Object& object, const glm::dvec3& scene_center_world, double margin_factor);

/// Coordinates of an object's vertices in the world.
std::vector<glm::dvec3> world_positions(const Object& object);

}  // namespace laterna
