#include "render/effects/rig_move.h"

#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

#include <numbers>

namespace laterna {
namespace {

Scene moving(const std::string& device) {
  Scene scene = testing::facing_plane();
  scene.cameras[0].device.name = "eye";
  scene.projectors[0].device.name = "lamp";
  scene.effects.timing = true;
  scene.timing.moved = {device, 3, {0, 0, std::numbers::pi / 2}, {0.1, 0, 0}};
  return scene;
}

TEST(RigMove, ConcernsTheSequencesOfItsDevice) {
  Scene scene = moving("eye");
  scene.projectors.push_back(scene.projectors[0]);
  scene.projectors[1].device.name = "other";
  EXPECT_TRUE(moves(scene, 0, 0));
  EXPECT_TRUE(moves(scene, 0, 1));
  scene.timing.moved.device = "other";
  EXPECT_FALSE(moves(scene, 0, 0));
  EXPECT_TRUE(moves(scene, 0, 1));
  scene.effects.timing = false;
  EXPECT_FALSE(moves(scene, 0, 1));
}

TEST(RigMove, ActsInTheDevicesFrame) {
  const Scene scene = moving("lamp"), moved = after_move(scene);
  const glm::dvec3 point(0.3, 0.2, 0.4);
  const glm::dvec3 before = apply(scene.projectors[0].device.device_from_world, point);
  const glm::dvec3 after = apply(moved.projectors[0].device.device_from_world, point);
  const glm::dvec3 expected(-before.y + 0.1, before.x, before.z);  // a quarter turn, then 0.1 m along x
  EXPECT_LT(glm::length(after - expected), 1e-14);                 // a few roundings
  EXPECT_EQ(apply(moved.cameras[0].device.device_from_world, point),
            apply(scene.cameras[0].device.device_from_world, point));
  EXPECT_FALSE(moves(moved, 0, 0));
}

TEST(RigMove, SplicesFromItsPictureOn) {
  ImageStack<std::uint8_t> first(3, 2, 4), second(3, 2, 4);
  std::fill(first.values.begin(), first.values.end(), std::uint8_t(1));
  std::fill(second.values.begin(), second.values.end(), std::uint8_t(2));
  CapturedStack spliced = first;
  splice(spliced, second, 3);
  for (int k = 0; k < 4; ++k)
    for (const std::uint8_t dn : std::get<0>(spliced).picture(k)) EXPECT_EQ(dn, k < 3 ? 1 : 2);
}

}  // namespace
}  // namespace laterna
