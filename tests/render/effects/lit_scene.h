// A traced scene with its effects applied.
#pragma once

#include "render/effects/apply_effects.h"
#include "render/effects/camera_show.h"
#include "render/effects/pixel_geometry.h"
#include "tests/render/rig.h"

#include <cstring>

namespace laterna::testing {

struct Lit {
  RayScene rays;
  SurfaceMap surface;
  std::vector<LightMap> lights;
  PixelArray<glm::dvec3> points;  ///< in the world

  explicit Lit(const Scene& scene) : rays(scene), surface(trace_surface(rays, scene, scene.cameras[0])) {
    points = points_world(surface, scene);
    for (const Projector& projector : scene.projectors)
      lights.push_back(trace_light(rays, scene, surface, projector));
    apply_effects(surface, lights, rays, scene, scene.cameras[0]);
  }
  const LightMap& light() const { return lights[0]; }
  std::size_t size() const { return points.values.size(); }
};

/// A plane at z = 0 that fills the camera's picture, lit from `projector_m` at a right angle.
inline Scene facing_plane(const glm::dvec3& projector_m = {0.2, -0.1, 2}) {
  return scene_of({object_of(plane(4, 4))}, device_at({0.1, 0, 2}, {0.1, 0, 0}, {60, 40}, 80),
                  device_at(projector_m, {projector_m.x, projector_m.y, 0}, {100, 80}, 60));
}

/// What the first camera sees the first projector play, in cd/m²: white light's rows through colour, camera
/// glare and timing.
inline ImageStack<float> played(const Scene& scene) {
  const Lit lit(scene);
  const ImageRows rows{{lit.surface.width, lit.surface.height},
                       [&](LightRows& r) { direct_rows(lit.surface, lit.light(), {}, scene.ambient_lx, r); }};
  const CameraShow show = make_camera_show(scene, 0, 0, rows);
  return play_luminance(show.rows, scene.projectors[0].lookup, show.show());
}

/// A slide of one value per primary, and one for grey.
inline std::shared_ptr<const Slide> plain_slide(glm::ivec2 size, const glm::vec3& rgb, float grey) {
  Slide slide{Image<float>(size.x, size.y, grey), true};
  for (int j = 0; j < 3; ++j) slide.primaries.emplace_back(size.x, size.y, rgb[j]);
  return std::make_shared<const Slide>(std::move(slide));
}

template <class T>
bool same_bits(const PixelArray<T>& a, const PixelArray<T>& b) {
  return a.values.size() == b.values.size() &&
         std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(T)) == 0;
}

}  // namespace laterna::testing
