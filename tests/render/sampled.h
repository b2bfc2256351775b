// Rows of light of a relief in several samples a pixel, and a pattern to play through them.
#pragma once

#include "render/image_rows.h"
#include "render/trace_rows.h"
#include "sim/shapes.h"
#include "tests/render/rig.h"
#include "tests/testing.h"

namespace laterna::testing {

/// Values from the test's own seed.
inline PatternStack random_pattern(glm::ivec2 size, int count) {
  auto random = testing::generator();
  PatternStack patterns = constant_pattern(size, count, 0);
  for (auto& value : patterns.values) value = std::uint8_t(random());
  return patterns;
}

/// A camera of 130×90 pixels and a projector of 60×40 look at a relief.
struct Sampled {
  Scene scene;
  RayScene rays;
  CameraRays directions;

  Sampled()
      : scene(scene_of({object_of(relief(2, 2, 0.3, 40, 40))},
                       device_at({0.3, 0, 3}, {0, 0, 0}, {130, 90}, 150),
                       device_at({-0.3, 0, 3}, {0, 0, 0}, {60, 40}, 60))),
        rays(scene),
        directions(scene.cameras[0].device) {}
  ImageRows image(int samples, glm::ivec2 region_px = {256, 4}) const {
    return {{130, 90}, trace_rows(rays, scene, 0, directions, 0, {samples, 9}), region_px};
  }
};

}  // namespace laterna::testing
