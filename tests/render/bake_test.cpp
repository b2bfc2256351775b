#include "render/bake.h"

#include "tests/render/rig.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using testing::device_at;
using testing::object_of;
using testing::scene_of;

// A photograph whose value is affine in the pixel, which a bilinear lookup gives back exactly.
Image<float> ramp(glm::ivec2 size) {
  Image<float> image(size.x, size.y);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) image(x, y) = 0.1f + 0.002f * float(x) + 0.003f * float(y);
  return image;
}

TEST(BakePhotograph, ATexelHoldsThePixelThatSeesItsPoint) {
  // A camera 2 m before a plane of 1 m × 1 m: u = 100·x/2 + 79.5, v = -100·y/2 + 59.5; s = x + 1/2, t = y +
  // 1/2.
  const Scene scene = scene_of({object_of(plane(1, 1))}, device_at({0, 0, 2}, {0, 0, 0}, {160, 120}, 100),
                               device_at({0, 0, 2}, {0, 0, 0}, {8, 8}, 8));
  const RayScene rays(scene);
  const BakedTexture texture = bake_photograph(rays, scene, 0, scene.cameras[0], ramp({160, 120}), 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      ASSERT_EQ(texture.covered(x, y), 1);
      const double u = 50 * ((x + 0.5) / 64 - 0.5) + 79.5, v = -50 * (0.5 - (y + 0.5) / 64) + 59.5;
      EXPECT_NEAR(texture.value(x, y), 0.1 + 0.002 * u + 0.003 * v, 1e-6);  // single precision
    }
  }
}

TEST(BakePhotograph, WhatTheCameraDoesNotSeeStaysUncovered) {
  // A wall of half the plane's size stands half way: it hides the middle quarter's area of 1 m × 1 m.
  Scene scene =
      scene_of({object_of(plane(1, 1)), object_of(plane(0.25, 0.25), {0, 0, 1})},
               device_at({0, 0, 2}, {0, 0, 0}, {160, 120}, 100), device_at({0, 0, 2}, {0, 0, 0}, {8, 8}, 8));
  const RayScene rays(scene);
  const BakedTexture texture = bake_photograph(rays, scene, 0, scene.cameras[0], ramp({160, 120}), 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      EXPECT_EQ(texture.covered(x, y), std::max(std::abs(x - 31.5), std::abs(y - 31.5)) < 16 ? 0 : 1);
  // Seen from behind, nothing is.
  scene.cameras[0].device.device_from_world = device_from_world_looking_at({0, 0, -2}, {0, 0, 0}, {0, 1, 0});
  const BakedTexture behind = bake_photograph(rays, scene, 0, scene.cameras[0], ramp({160, 120}), 16);
  EXPECT_EQ(std::count(behind.covered.values.begin(), behind.covered.values.end(), 1), 0);
}

TEST(BakePhotograph, RefusesWhatCannotBeBaked) {
  Scene scene = scene_of({object_of(plane(1, 1))}, device_at({0, 0, 2}, {0, 0, 0}, {160, 120}, 100),
                         device_at({0, 0, 2}, {0, 0, 0}, {8, 8}, 8));
  const RayScene rays(scene);
  const auto error = [&](const Image<float>& photo, int size_px) {
    return testing::input_error([&] { bake_photograph(rays, scene, 0, scene.cameras[0], photo, size_px); });
  };
  EXPECT_EQ(error(ramp({16, 12}), 8), "device: a photograph of 16x12 pixels, expected the camera's 160x120");
  EXPECT_EQ(error(ramp({160, 120}), 0), "texture: a size of 0 was found, expected 1 to 16384");
  scene.objects[0].mesh.texture_coordinates[0].x = 1e6;
  EXPECT_THAT(error(ramp({160, 120}), 8), ::testing::HasSubstr("expected -16 to 16"));
  scene.objects[0].mesh.texture_coordinates.clear();
  EXPECT_THAT(error(ramp({160, 120}), 8), ::testing::HasSubstr("has no texture coordinates"));
}

}  // namespace
}  // namespace laterna
