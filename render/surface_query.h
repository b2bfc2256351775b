// Questions about single points of a scene's surface: what lies nearest, and what a ray meets first.
#pragma once

#include "render/ray_scene.h"
#include "sim/scene.h"

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace laterna {

/// Lengths in metres, points in the world. Embree finds triangles in single precision; distances and points
/// are then those of the triangles in double.
class SurfaceQuery {
 public:
  /// `scene` is the one that `rays` was made from; both must outlive this object.
  SurfaceQuery(const RayScene& rays, const Scene& scene);

  /// min(|x - y|, most_m) over the points y of all triangles, seen or not, of either side. x farther than
  /// 1e30 m from the scene's centre: most_m.
  double distance_m(const glm::dvec3& x_world, double most_m) const;

  /// The first point of the surface on each ray from `origin_world`; NaN where it meets none, or its
  /// direction is NaN. One ray in a million may slip through an edge (RayScene).
  std::vector<glm::dvec3> first_points(const glm::dvec3& origin_world,
                                       std::span<const glm::dvec3> directions_world) const;

 private:
  glm::dvec3 on_plane(const RayPacket& rays, int lane, const glm::dvec3& origin_relative,
                      const glm::dvec3& direction) const;

  const RayScene& rays_;
  const Scene& scene_;
  std::vector<std::vector<glm::dvec3>> vertices_;  ///< one list per object, relative to the scene's centre
};

/// The distance from x to the triangle abc, its inside, edges and corners; also where it is degenerate.
double distance_to_triangle(const glm::dvec3& x, const glm::dvec3& a, const glm::dvec3& b,
                            const glm::dvec3& c);

}  // namespace laterna
