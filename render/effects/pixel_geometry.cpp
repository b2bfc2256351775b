#include "render/effects/pixel_geometry.h"

#include "render/effects/normal_map.h"

namespace laterna {

PixelGeometry::PixelGeometry(const SurfaceMap& surface, const RayScene& rays, const Scene& scene)
    : surface_(surface), rays_(rays), scene_(scene) {
  for (const Object& object : scene.objects)
    origin_relative_.push_back(glm::dvec3(object.world_from_object[3]) - rays.center_world());
}

glm::dvec3 PixelGeometry::point(std::size_t p) const {
  const std::uint32_t id = surface_.object.values[p];
  return glm::dmat3(scene_.objects[id].world_from_object) * surface_.point_object.values[p] +
         origin_relative_[id];
}

glm::dvec3 PixelGeometry::flat_normal(std::size_t p) const {
  return rays_.plane(surface_.object.values[p], surface_.triangle.values[p]).normal_world;
}

glm::dvec3 PixelGeometry::normal(std::size_t p) const {
  const Object& seen = object(p);
  if (!scene_.effects.normal_map || !seen.normal_map) return flat_normal(p);
  return mapped_normal(seen, surface_.triangle.values[p], surface_.point_object.values[p], flat_normal(p));
}

glm::dvec3 PixelGeometry::center(const Device& device) const {
  return center_in_world(device.device_from_world) - rays_.center_world();
}

}  // namespace laterna
