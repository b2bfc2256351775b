#include "render/camera_rays.h"

#include "tests/render/rig.h"
#include "tests/testing.h"

namespace laterna {
namespace {

using testing::device_at;

TEST(CameraRays, APinholeByHand) {
  Device camera;
  camera.intrinsics = {{4, 3}, 2, 4, 1.5, 1};
  const CameraRays rays(camera);
  EXPECT_EQ(rays.direction(0, 0), glm::dvec2(-0.75, -0.25));
  EXPECT_EQ(rays.direction(3, 2), glm::dvec2(0.75, 0.25));
}

TEST(CameraRays, ALensProjectsEachDirectionBackToItsPixel) {
  Device camera = device_at({0, 0, 1}, {0, 0, 0}, {64, 48}, 60);
  camera.lens = {"LENSMODEL_OPENCV4", {-0.1, 0.02, 0.001, -0.002}};
  const CameraRays rays(camera);
  const LensProjection lens(camera.intrinsics, camera.lens);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const auto pixel = lens.project(glm::dvec3(rays.direction(x, y), 1.0));
      ASSERT_TRUE(pixel);
      EXPECT_NEAR(glm::distance(*pixel, glm::dvec2(x, y)), 0, 2e-9);  // unproject promises 1e-9
    }
  }
}

TEST(CameraRays, PixelsThatTheLensCannotSeeAreMarkedAndSeeNothing) {
  Device camera = device_at({0, 0, 1}, {0, 0, 0}, {64, 48}, 20);
  camera.lens = {"LENSMODEL_OPENCV4", {-0.5, 0, 0, 0}};  // folds over at r = 0.82
  const CameraRays rays(camera);
  EXPECT_TRUE(std::isnan(rays.direction(0, 0).x));
  EXPECT_FALSE(std::isnan(rays.direction(32, 24).x));
  const Scene scene = testing::scene_of({testing::object_of(plane(50, 50))}, camera, camera);
  const testing::Traced traced(scene);
  EXPECT_EQ(traced.surface.object(0, 0), no_hit);
  EXPECT_EQ(traced.surface.object(32, 24), 0u);
}

}  // namespace
}  // namespace laterna
