// What each pixel of a camera sees: the surface point behind the pixel's centre.
#pragma once

#include "render/camera_rays.h"
#include "render/pixel_array.h"
#include "render/ray_scene.h"
#include "sim/scene.h"

#include <glm/glm.hpp>

namespace laterna {

/// One entry per camera pixel, of the whole image or of a region of it. Where nothing is hit, object and
/// triangle are no_hit, albedo is 0, and point and depth are NaN. World points and normals follow from these:
/// see below.
struct SurfaceMap {
  int width = 0, height = 0;
  PixelArray<std::uint32_t> object;     ///< index into Scene::objects, or no_hit
  PixelArray<std::uint32_t> triangle;   ///< index into that object's triangles, or no_hit
  PixelArray<glm::dvec3> point_object;  ///< metres, in the object's frame
  PixelArray<double> depth_m;           ///< along the camera's optical axis
  PixelArray<float>
      albedo;  ///< with the albedo map; 0 where the back side is seen (but with Effects::back_face off)
  PixelArray<std::uint8_t> seen_front;  ///< 1 where the camera sees the front side, else 0
  glm::ivec2 first_px{0, 0};            ///< the camera pixel that stands first

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

/// The camera as one object sees it: x_object = camera_object + depth·object_from_device·(x/z, y/z, 1).
struct ObjectView {
  glm::dmat3 object_from_device;
  glm::dvec3 camera_from_center, camera_object;  ///< from the mesh's middle; from the object's origin
  float albedo, back_albedo;                     ///< seen from the front; from the back
  const Object* textured;                        ///< null without an albedo map
};

/// A camera ready to be traced region by region. What it was made from must outlive it.
struct CameraView {
  glm::dvec3 camera_relative;  ///< in world axes, relative to the scene's centre
  glm::dmat3 world_from_device;
  std::vector<ObjectView> objects;
};
CameraView make_camera_view(const RayScene& rays, const Scene& scene, const Camera& camera);

/// Rays that start beside the camera's centre: that of pixel p of a map starts at points_m[p], x and y in the
/// camera's plane z = 0, and meets the pixel's ray through the centre at axial depth focus_m.
struct LensPoints {
  double focus_m;
  const glm::vec2* points_m;
};

/// A map of a region with nothing written yet.
SurfaceMap make_surface_map(const PixelRegion& region);

/// Traces row `tile_row` of the map's 4×4 tiles: the same numbers as in the map of the whole image. Where
/// `offsets_px` is given, one per pixel of the map, rays pass that far beside the pixels' centres;
/// where `lens` is, they start there.
void trace_surface_tiles(const RayScene& rays, const CameraView& view, const CameraRays& directions,
                         int tile_row, SurfaceMap& map, const glm::vec2* offsets_px = nullptr,
                         const LensPoints* lens = nullptr);

/// What each pixel sees in world coordinates, in metres; NaN where nothing is hit.
PixelArray<glm::dvec3> points_world(const SurfaceMap& surface, const Scene& scene);

/// The unit normal in the world of the flat triangle that entry p of the map sees, towards its front side; 0
/// where nothing is hit.
inline glm::dvec3 normal_world(const SurfaceMap& surface, const RayScene& rays, std::size_t p) {
  return surface.hit(p) ? rays.plane(surface.object.values[p], surface.triangle.values[p]).normal_world
                        : glm::dvec3(0.0);
}

/// The same for the whole map.
PixelArray<glm::dvec3> normals_world(const SurfaceMap& surface, const RayScene& rays);

}  // namespace laterna
