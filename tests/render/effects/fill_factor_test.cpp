// Pixels active in part: the panel's screen door, and the camera's.
#include "render/effects/fill_factor.h"

#include "tests/render/rig.h"
#include "tests/testing.h"

namespace laterna {
namespace {

using testing::device_at;
using testing::object_of;
using testing::scene_of;

// Camera and projector at one place before a plane; a camera pixel is 1/`zoom` of a projector pixel.
Scene coaxial(double zoom) {
  Scene scene = scene_of({object_of(plane(40, 40))}, device_at({0, 0, 2}, {0, 0, 0}, {80, 80}, 100 * zoom),
                         device_at({0, 0, 2}, {0, 0, 0}, {120, 120}, 100));
  scene.effects.fill_factor = true;
  return scene;
}

ImageStack<float> white_of(const Scene& scene) {
  const RayScene rays(scene);
  const CameraRays directions(scene.cameras[0].device);
  const ImageRows image{{80, 80},
                        trace_rows(rays, scene, 0, directions, 0, samples_of(scene, 0, testing::seed()))};
  return play_luminance(image, Lookup::nearest, testing::constant_pattern({120, 120}, 1, 255));
}

TEST(FillFactor, APanelPixelEmitsFromItsMiddleAndKeepsItsFlux) {
  Scene scene = coaxial(10);
  const auto whole = white_of(scene);
  scene.projectors[0].effects.optics.fill_factor = 0.64;  // a side of 0.8 px: 8 camera pixels of 10
  const auto door = white_of(scene);
  double sum = 0, before = 0;
  for (std::size_t p = 0; p < door.values.size(); ++p) {
    const glm::dvec2 at = glm::dvec2(p % 80, p / 80) / 10.0 - 3.95 + 59.5;  // projector pixel
    const glm::dvec2 beside = glm::abs(at - glm::floor(at + 0.5));
    const bool active = std::max(beside.x, beside.y) < 0.4;
    // Single precision.
    EXPECT_NEAR(door.values[p], active ? whole.values[p] / 0.64 : 0, 1e-5 * whole.values[p]) << p;
    sum += door.values[p], before += whole.values[p];
  }
  EXPECT_NEAR(sum / before, 1, 1e-5);  // 8×8 whole pixels on a plane of even light
}

TEST(FillFactor, ACameraPixelIsTheMeanOverItsMiddle) {
  Scene scene = coaxial(1);
  scene.effects.antialiasing = true;
  scene.cameras[0].samples_per_pixel = 64;
  scene.cameras[0].optics.fill_factor = 0.25;
  const RayScene rays(scene);
  const CameraRays directions(scene.cameras[0].device);
  LightRows rows;
  rows.region = {0, 0, 80, 80};
  trace_rows(rays, scene, 0, directions, 0, samples_of(scene, 0, testing::seed()))(rows);
  double widest = 0, mean2 = 0;
  for (std::size_t p = 0; p < rows.region.size(); ++p) {
    for (std::uint32_t e = rows.begin[p]; e < rows.begin[p + 1]; ++e) {
      const double beside = rows.entries[e].u_px - (double(p % 80) + 20);
      widest = std::max(widest, std::abs(beside));
      mean2 += beside * beside / double(rows.entries.size());
    }
  }
  EXPECT_LE(widest, 0.25 + 1e-9);
  EXPECT_GT(widest, 0.249);
  EXPECT_NEAR(mean2, 0.25 / 12, 1e-4);  // a box of side 1/2; 409600 stratified rays
}

TEST(FillFactor, OffOrWholeLeavesNoTrace) {
  Scene scene = coaxial(1);
  EXPECT_EQ(active_side_px(scene.effects, {}), 1);
  EXPECT_TRUE(rows_are_direct(scene, 0));
  scene.projectors[0].effects.optics.fill_factor = 0.5;
  EXPECT_FALSE(rows_are_direct(scene, 0));
  scene.effects.fill_factor = false;
  EXPECT_TRUE(rows_are_direct(scene, 0));
  EXPECT_EQ(active_side_px(scene.effects, scene.projectors[0].effects.optics), 1);
}

}  // namespace
}  // namespace laterna
