// What each pixel of a camera sees: the surface point behind the pixel's centre.
#pragma once

#include "render/camera_rays.h"
#include "render/pixel_array.h"
#include "render/ray_scene.h"
#include "sim/scene.h"

#include <glm/glm.hpp>

namespace laterna {

/// One entry per camera pixel. Where nothing is hit, object and triangle are no_hit, albedo is 0, and point
/// and depth are NaN. World points and normals follow from these: see below.
struct SurfaceMap {
  int width = 0, height = 0;
  PixelArray<std::uint32_t> object;     ///< index into Scene::objects, or no_hit
  PixelArray<std::uint32_t> triangle;   ///< index into that object's triangles, or no_hit
  PixelArray<glm::dvec3> point_object;  ///< metres, in the object's frame
  PixelArray<double> depth_m;           ///< along the camera's optical axis
  PixelArray<float>
      albedo;  ///< with the albedo map; 0 where the back side is seen (but with Effects::back_face off)
  PixelArray<std::uint8_t> seen_front;  ///< 1 where the camera sees the front side, else 0

  bool hit(std::size_t i) const { return object.values[i] != no_hit; }
};

/// Traces one ray per pixel, through its centre. Embree names the triangle; the point is where the ray, in
/// double, meets that triangle's plane. A ray that in double passes the triangle's edge by a rounding error
/// still takes the plane; where plane and ray are so nearly parallel that this would move the point by more
/// than a thousandth of the depth, Embree's own depth stands. `scene` is the one that `rays` was made from.
SurfaceMap trace_surface(const RayScene& rays, const Scene& scene, const Camera& camera);

/// The same with the camera's rays at hand.
SurfaceMap trace_surface(const RayScene& rays, const Scene& scene, const Camera& camera,
                         const CameraRays& directions);

/// What each pixel sees in world coordinates, in metres; NaN where nothing is hit.
PixelArray<glm::dvec3> points_world(const SurfaceMap& surface, const Scene& scene);

/// The unit normal in the world of the flat triangle that each pixel sees, towards its front side; 0 where
/// nothing is hit.
PixelArray<glm::dvec3> normals_world(const SurfaceMap& surface, const RayScene& rays);

}  // namespace laterna
