// Scenes that the render tests share, and a capture in one call.
#pragma once

#include "render/automatic_exposure.h"
#include "render/replay.h"
#include "render/trace_rows.h"
#include "sim/shapes.h"

#include <glm/gtc/matrix_transform.hpp>

namespace laterna::testing {

inline Device device_at(const glm::dvec3& position, const glm::dvec3& target, glm::ivec2 size, double focal,
                        const glm::dvec3& up = {0, 1, 0}) {
  Device device;
  device.name = "device";
  device.intrinsics = {size, focal, focal, (size.x - 1) / 2.0, (size.y - 1) / 2.0};
  device.device_from_world = device_from_world_looking_at(position, target, up);
  return device;
}

inline Object object_of(const Mesh& mesh, const glm::dvec3& position = glm::dvec3(0.0)) {
  return {"object", mesh, glm::translate(glm::dmat4(1.0), position), 0.8, nullptr};
}

/// A scene with one camera and one projector.
inline Scene scene_of(std::vector<Object> objects, const Device& camera, const Device& projector) {
  Scene scene;
  scene.objects = std::move(objects);
  scene.cameras = {Camera{camera, {}}};
  scene.projectors = {Projector{projector, 1000, Lookup::nearest, Border::black}};
  return scene;
}

struct Traced {
  RayScene rays;
  SurfaceMap surface;
  LightMap light;

  explicit Traced(const Scene& scene)
      : rays(scene),
        surface(trace_surface(rays, scene, scene.cameras[0])),
        light(trace_light(rays, scene, surface, scene.projectors[0])) {}
  int count(Unlit why) const {
    return int(std::count(light.why.values.begin(), light.why.values.end(), std::uint8_t(why)));
  }
};

/// The luminance that fills the scale with automatic exposure, without ambient light.
inline double automatic_saturation(const Traced& traced) {
  const ImageRows image{{traced.surface.width, traced.surface.height},
                        [&](LightRows& rows) { direct_rows(traced.surface, traced.light, {}, 0, rows); }};
  return automatic_saturation_cd_per_m2({&image, 1});
}

inline PatternStack constant_pattern(glm::ivec2 size, int count, std::uint8_t value) {
  return {size.x, size.y, count, std::vector<std::uint8_t>(std::size_t(size.x) * size.y * count, value)};
}

}  // namespace laterna::testing
