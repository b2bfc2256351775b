// Rigs for the tests of calibration formats.
#pragma once

#include "sim/formats/rig.h"
#include "tests/testing.h"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

namespace laterna::testing {

/// The device of a name; fails the test where there is none.
inline Device device_called(const Rig& rig, const std::string& name) {
  for (const auto* devices : {&rig.cameras, &rig.projectors})
    for (const Device& device : *devices)
      if (device.name == name) return device;
  ADD_FAILURE() << "no device is called " << name;
  return {};
}

/// Where a world point lands.
inline glm::dvec2 rig_pixel(const Rig& rig, const std::string& name, const glm::dvec3& x_world) {
  return WorldProjection(device_called(rig, name)).project(x_world);
}

/// 1e-9 px: a few roundings of thousands of pixels.
#define EXPECT_PIXEL(pixel, u, v)           \
  do {                                      \
    const glm::dvec2 pixel_found = (pixel); \
    EXPECT_NEAR(pixel_found.x, u, 1e-9);    \
    EXPECT_NEAR(pixel_found.y, v, 1e-9);    \
  } while (false)

inline Device random_device(std::mt19937_64& random, const std::string& name, const std::string& model,
                            int terms) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto u = [&] { return uniform(random); };
  Device device;
  device.name = name;
  device.intrinsics = {{640, 480}, 800 + 50 * u(), 805 + 50 * u(), 320 + 20 * u(), 240 + 300 * u()};
  device.lens.model = model;
  for (int i = 0; i < terms; ++i) device.lens.parameters.push_back(1e-3 * u());
  device.device_from_world =
      rigid_from_rotation_vector(glm::dvec3(u(), u(), u()) * (std::numbers::pi / 8), {u(), u(), 1 + u()});
  return device;
}

/// "camera" and "projector" in a world of their own.
inline Rig random_pair(std::mt19937_64& random, const std::string& model, int terms) {
  Rig rig;
  rig.cameras.push_back(random_device(random, "camera", model, terms));
  rig.projectors.push_back(random_device(random, "projector", model, terms));
  return rig;
}

/// Intrinsics and lens to the bit where `tolerance` is small, else to it relatively; placement to it.
inline void expect_same(const Device& a, const Device& b, double tolerance) {
  SCOPED_TRACE(b.name);
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.intrinsics.size, b.intrinsics.size);
  EXPECT_NEAR(a.intrinsics.fx, b.intrinsics.fx, 1000 * tolerance);
  EXPECT_NEAR(a.intrinsics.fy, b.intrinsics.fy, 1000 * tolerance);
  EXPECT_NEAR(a.intrinsics.cx, b.intrinsics.cx, 1000 * tolerance);
  EXPECT_NEAR(a.intrinsics.cy, b.intrinsics.cy, 1000 * tolerance);
  EXPECT_EQ(a.lens, b.lens);
  EXPECT_LE(glm::distance(a.device_from_world.translation, b.device_from_world.translation), tolerance);
  for (int c = 0; c < 3; ++c)
    EXPECT_LE(glm::distance(a.device_from_world.rotation[c], b.device_from_world.rotation[c]), tolerance);
}

inline void expect_same(const Rig& a, const Rig& b, double tolerance) {
  ASSERT_EQ(a.cameras.size(), b.cameras.size());
  ASSERT_EQ(a.projectors.size(), b.projectors.size());
  for (std::size_t i = 0; i < a.cameras.size(); ++i) expect_same(a.cameras[i], b.cameras[i], tolerance);
  for (std::size_t i = 0; i < a.projectors.size(); ++i)
    expect_same(a.projectors[i], b.projectors[i], tolerance);
}

}  // namespace laterna::testing
