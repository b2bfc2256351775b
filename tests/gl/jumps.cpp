#include "tests/gl/jumps.h"

#include <algorithm>
#include <cmath>

namespace laterna::gl {

namespace {

// Each pixel's plane in the camera's frame as its inverse depth over the picture: w(x, y) = w0·(x/z, y/z, 1).
struct Planes {
  const Scene& scene;
  const SurfaceMap& surface;
  CameraRays directions;
  PixelArray<glm::dvec3> inverse_depth;

  Planes(const Scene& whole, const RayScene& rays, const SurfaceMap& seen)
      : scene(whole),
        surface(seen),
        directions(scene.cameras[0].device),
        inverse_depth(seen.width, seen.height) {
    const PixelArray<glm::dvec3> normals = normals_world(surface, rays),
                                 points = points_world(surface, scene);
    const Rigid& camera_from_world = scene.cameras[0].device.device_from_world;
    for (std::size_t p = 0; p < normals.values.size(); ++p) {
      const glm::dvec3 normal = camera_from_world.rotation * normals.values[p];
      inverse_depth.values[p] = normal / glm::dot(normal, apply(camera_from_world, points.values[p]));
    }
  }
  double at(std::size_t plane, int x, int y) const {
    return glm::dot(inverse_depth.values[plane], glm::dvec3(directions.direction(x, y), 1));
  }
  bool share_a_vertex(std::size_t a, std::size_t b) const {
    const std::uint32_t object = surface.object.values[a];
    if (object != surface.object.values[b]) return false;
    const auto& triangles = scene.objects[object].mesh.triangles;
    const glm::uvec3 of_b = triangles[surface.triangle.values[b]];
    const auto has = [&](std::uint32_t v) { return v == of_b.x || v == of_b.y || v == of_b.z; };
    const glm::uvec3 of_a = triangles[surface.triangle.values[a]];
    return has(of_a.x) || has(of_a.y) || has(of_a.z);
  }
  bool joined(glm::ivec2 i, glm::ivec2 j) const {
    const std::size_t a = inverse_depth.index(i.x, i.y), b = inverse_depth.index(j.x, j.y);
    if (!surface.hit(a) || !surface.hit(b)) return surface.hit(a) == surface.hit(b);
    if (share_a_vertex(a, b)) return true;
    const double at_i = at(a, i.x, i.y) - at(b, i.x, i.y), at_j = at(a, j.x, j.y) - at(b, j.x, j.y);
    return at_i * at_j <= 0 || std::max(std::abs(at_i), std::abs(at_j)) <= 1e-6 * at(a, i.x, i.y);
  }
};

}  // namespace

Image<std::uint8_t> near_jumps(const Scene& scene, const RayScene& rays, const SurfaceMap& surface) {
  const Planes planes(scene, rays, surface);
  Image<std::uint8_t> near(surface.width, surface.height);
  const auto mark = [&](glm::ivec2 i, glm::ivec2 j) {
    // All pixels whose 3×3 hold both.
    const glm::ivec2 low = glm::max(glm::max(i, j) - 1, glm::ivec2(0)),
                     high = glm::min(glm::min(i, j) + 1, glm::ivec2(surface.width - 1, surface.height - 1));
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) near(x, y) = 1;
  };
  for (int y = 0; y < surface.height; ++y)
    for (int x = 0; x < surface.width; ++x)
      for (const glm::ivec2 j : {glm::ivec2(x + 1, y), glm::ivec2(x, y + 1)})
        if (j.x < surface.width && j.y < surface.height && !planes.joined({x, y}, j)) mark({x, y}, j);
  return near;
}

}  // namespace laterna::gl
