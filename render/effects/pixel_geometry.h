// Where the point behind a camera pixel stands, for the effects that weigh its light.
#pragma once

#include "render/direct_light.h"
#include "sim/parallel.h"

#include <glm/glm.hpp>

#include <vector>

namespace laterna {

/// Points and normals of a surface in world axes, relative to the scene's centre. What it is made from must
/// outlive it.
class PixelGeometry {
 public:
  PixelGeometry(const SurfaceMap& surface, const RayScene& rays, const Scene& scene);

  /// Of a pixel that sees a surface, in metres.
  glm::dvec3 point(std::size_t p) const;
  /// Unit, of the flat triangle; with Effects::normal_map and a map, the map's.
  glm::dvec3 normal(std::size_t p) const;
  glm::dvec3 flat_normal(std::size_t p) const;
  /// A device's centre, in metres.
  glm::dvec3 center(const Device& device) const;
  /// The point in a device's frame, in metres.
  glm::dvec3 in_device(const Device& device, std::size_t p) const {
    return device.device_from_world.rotation * (point(p) - center(device));
  }
  const Object& object(std::size_t p) const { return scene_.objects[surface_.object.values[p]]; }
  const SurfaceMap& surface() const { return surface_; }

 private:
  const SurfaceMap& surface_;
  const RayScene& rays_;
  const Scene& scene_;
  std::vector<glm::dvec3> origin_relative_;  // of each object
};

/// Multiplies the weight of each lit pixel by factor(pixel).
template <class Factor>
void weigh(LightMap& light, const Factor& factor) {
  parallel_for(std::size_t(light.height), [&](std::size_t y) {
    for (std::size_t p = y * light.width; p < (y + 1) * light.width; ++p)
      if (light.lit(p)) light.white_lx.values[p] *= factor(p);
  });
}

/// Multiplies the albedo of each pixel that sees a surface by factor(pixel).
template <class Factor>
void weigh_albedo(SurfaceMap& surface, const Factor& factor) {
  parallel_for(std::size_t(surface.height), [&](std::size_t y) {
    for (std::size_t p = y * surface.width; p < (y + 1) * surface.width; ++p)
      if (surface.hit(p)) surface.albedo.values[p] *= static_cast<float>(factor(p));
  });
}

}  // namespace laterna
