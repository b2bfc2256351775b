// A camera may be wrong beside a projector that is right.
#include "apps/lab/score/camera_score.h"

#include "apps/lab/score/score.h"
#include "apps/lab/trial.h"
#include "sim/scene_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>

namespace laterna {
namespace {

Scene small_scene() {
  return build_scene(parse_scene(R"(
[[mesh]]
shape = "relief"
shape_size = [1.6, 1.0, 0.7]
seed = 7
[[projector]]
size = [160, 100]
throw_ratio = 1.2
position = [0.35, -0.1, 2.1]
look_at = [0, 0, 0]
up = [0, 1, 0]
[[camera]]
size = [200, 125]
fov_x_deg = 42
position = [-0.35, 0.15, 2.0]
look_at = [0, 0, 0]
up = [0.1, 1, 0]
)",
                                 "small.toml"),
                     ".");
}

class CameraScore : public ::testing::Test {
 protected:
  CameraScore() : scene(small_scene()), truth{scene.cameras[0].device, scene.projectors[0].device} {
    StageTimes times;
    surface = lit_points(trace(scene, times), 0);
  }
  double error_px(const Device& camera, const Alignment& alignment) const {
    return camera_error_px({camera, truth.projector}, truth, alignment, surface);
  }
  std::string first_name(const Device& camera) const {
    const auto suspects = camera_suspects({camera, truth.projector}, truth, {}, surface);
    return suspects.empty() ? "" : suspects[0].name;
  }
  Scene scene;
  ScoreRig truth;
  LargeVector<glm::dvec3> surface;
};

TEST_F(CameraScore, OfTheTrueCameraIsNothing) {
  for (const bool world : {false, true})
    EXPECT_LT(error_px(*truth.camera, {world, false}), 1e-9);  // roundings of some 200 px
  EXPECT_TRUE(std::isnan(camera_error_px({std::nullopt, truth.projector}, truth, {}, surface)));
}

TEST_F(CameraScore, APrincipalPointOffIsThatFarOff) {
  Device camera = *truth.camera;
  camera.intrinsics.cx += 3, camera.intrinsics.cy -= 4;
  for (const bool world : {false, true}) EXPECT_NEAR(error_px(camera, {world, false}), 5, 1e-9);
}

TEST_F(CameraScore, APlaceIsJudgedUnlessTheWorldMoves) {
  Device camera = *truth.camera;
  camera.device_from_world.translation.x += 0.1;
  EXPECT_GT(error_px(camera, {}), 1);
  EXPECT_LT(error_px(camera, {true, false}), 1e-9);
}

TEST_F(CameraScore, MistakesOfTheCameraAreNamed) {
  Device swapped = *truth.camera, half = swapped, other = swapped;
  std::swap(swapped.intrinsics.size.x, swapped.intrinsics.size.y);
  EXPECT_EQ(first_name(swapped), "size_swapped");
  half.intrinsics.cx += 0.5, half.intrinsics.cy += 0.5;
  EXPECT_EQ(first_name(half), "half_pixel");
  other.intrinsics.fx *= 1.05;
  EXPECT_NE(first_name(other), "unconverged");
}

TEST_F(CameraScore, AWrongCameraIsNeverOk) {
  const auto status = [&](const Device& camera) {
    return score({scene}, {Rig{{camera}, {truth.projector}}, {{}}}).at(0).status;
  };
  EXPECT_EQ(status(*truth.camera), Status::ok);
  Device camera = *truth.camera;
  camera.intrinsics.fx *= 1.1;
  EXPECT_EQ(status(camera), Status::weak);
}

}  // namespace
}  // namespace laterna
