#include "sim/device.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>

namespace laterna {
namespace {

Device real_projector() {
  Device device;
  device.name = "left";
  device.intrinsics = {{1920, 1080}, 2842.98, 2844.47, 958.83, 1096.37};
  device.device_from_world = device_from_world_looking_at({0.3, -1.0, 0.4}, {0, 0, 0}, {0, 0, 1});
  device.lens = {"LENSMODEL_OPENCV5", {-0.0485, -0.194, 0, 0, 0.738}};
  return device;
}

TEST(Device, ProjectGoesThroughTheTextureMatrix) {
  Device device = real_projector();
  device.lens = {};
  const glm::dvec3 x(0.02, 0.05, -0.03);
  const glm::dvec4 strq = texture_from_world(device) * glm::dvec4(x, 1);
  const glm::dvec3 uvq = WorldProjection(device).project(x);
  EXPECT_EQ(glm::dvec2(uvq), pixel_from_texture(strq, device.intrinsics.size));
  EXPECT_DOUBLE_EQ(uvq.z, apply(device.device_from_world, x).z);
}

TEST(Device, UnprojectInvertsProject) {
  const Device device = real_projector();
  const WorldProjection projection(device);
  for (double v = -0.5; v <= 1079.5; v += 120) {
    for (double u = -0.5; u <= 1919.5; u += 160) {
      const auto x = projection.unproject({u, v}, 1.7);
      ASSERT_TRUE(x);
      const glm::dvec3 uvq = projection.project(*x);
      EXPECT_NEAR(uvq.x, u, 2e-9);  // the lens inverse's 1e-9 px, and rounding
      EXPECT_NEAR(uvq.y, v, 2e-9);
      EXPECT_NEAR(uvq.z, 1.7, 1e-14);
    }
  }
}

TEST(Device, BehindIsNaNButKeepsItsDepth) {
  const Device device = real_projector();
  const glm::dvec3 uvq = WorldProjection(device).project({0.3, -2.0, 0.4});
  EXPECT_TRUE(std::isnan(uvq.x) && std::isnan(uvq.y));
  EXPECT_LT(uvq.z, 0);
}

TEST(Device, ValidateNamesTheDevice) {
  Device device = real_projector();
  device.planes = {3.0, 2.0};
  EXPECT_THAT(testing::input_error([&] { validate(device); }),
              ::testing::HasSubstr("left: near is 3 and far is 2"));
}

}  // namespace
}  // namespace laterna
