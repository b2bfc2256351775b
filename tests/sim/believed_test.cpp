#include "sim/believed.h"

#include "sim/ply.h"
#include "sim/scene_file.h"
#include "sim/self_contained.h"
#include "sim/shapes.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;

const std::string mesh = "[[mesh]]\nshape = \"relief\"\ntranslate = [1, 2, 3]\n";
const std::string camera =
    "[[camera]]\nsize = [640, 480]\nfx = 500\nposition = [0, 0, 2]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n";

Scene scene_of(const std::string& text) { return build_scene(parse_scene(text, "s"), "."); }
std::string error_of(const std::string& text) {
  return testing::input_error([&] { scene_of(text); });
}

glm::dvec3 in_world(const Object& object, std::size_t i) {
  return glm::dvec3(object.world_from_object * glm::dvec4(object.mesh.positions[i], 1.0));
}

TEST(Believed, WithoutBeliefsTheSceneIsItself) {
  const Scene scene = scene_of(mesh + camera);
  std::optional<Scene> storage;
  EXPECT_EQ(&believed(scene, storage), &scene);
  EXPECT_TRUE(told_covariance(scene, scene.cameras[0]).empty());
}

TEST(Believed, OneSwitchTurnsAllOff) {
  const std::string text = mesh + "[mesh.believed]\nscale = 1.01\n" + camera +
                           "[camera.believed]\nfocal_px = [1, 1]\nsigma_focal_px = [1, 1]\n";
  std::optional<Scene> storage;
  const Scene on = scene_of(text), off = scene_of("believe_truth = true\n" + text);
  EXPECT_NE(&believed(on, storage), &on);
  EXPECT_FALSE(told_covariance(on, on.cameras[0]).empty());
  EXPECT_EQ(&believed(off, storage), &off);
  EXPECT_TRUE(told_covariance(off, off.cameras[0]).empty());
}

// x_believed = o + translate + R·scale·(x - o): a quarter turn about z takes x to y.
TEST(Believed, AMeshIsMisplacedByHand) {
  const Scene scene = scene_of(
      "[[mesh]]\nshape = \"box\"\ntranslate = [1, 2, 3]\n"
      "[mesh.believed]\nscale = 2\nrotate_deg = [0, 0, 90]\ntranslate = [0, 0, 0.5]\n");
  const Object told = believed(scene.objects[0]);
  for (std::size_t i = 0; i < told.mesh.positions.size(); ++i) {
    const glm::dvec3 x = told.mesh.positions[i];  // welding keeps them
    EXPECT_LT(glm::distance(in_world(told, i), glm::dvec3(1 - 2 * x.y, 2 + 2 * x.x, 3.5 + 2 * x.z)), 1e-14);
  }
}

TEST(Believed, NoiseIsAlongTheNormalAndInMetresOfTheWorld) {
  // A plane that its placement enlarges a thousandfold and stands up: normals along -y in the world.
  const Scene scene = scene_of(
      "[[mesh]]\nshape = \"plane\"\ndetail = 100\nscale = 1000\nrotate_deg = [90, 0, 0]\n"
      "[mesh.believed]\nnoise_sigma_m = 0.02\nseed = 5\n");
  const Object told = believed(scene.objects[0]);
  double sum2 = 0;
  for (std::size_t i = 0; i < told.mesh.positions.size(); ++i) sum2 += std::pow(in_world(told, i).y, 2);
  const double n = double(told.mesh.positions.size());
  ASSERT_EQ(n, 101 * 101);
  EXPECT_NEAR(std::sqrt(sum2 / n), 0.02, 4 * 0.02 / std::sqrt(2 * n));  // four sigmas of a sample's
  const Object again = believed(scene.objects[0]);
  EXPECT_EQ(told.mesh.positions, again.mesh.positions);
  Scene other = scene;
  other.objects[0].belief.seed = 6;
  EXPECT_NE(told.mesh.positions, believed(other.objects[0]).mesh.positions);
}

TEST(Believed, KeepAndFile) {
  const testing::ScratchFolder folder;
  const Mesh other = make_shape({"sphere", {1, 1, 1}, 8, 1});
  const std::string bytes = ply_bytes(other);
  testing::write_text(folder / "other.ply", bytes);
  const SceneSpec spec = parse_scene(mesh + "believed = { file = \"other.ply\", keep = 0.25 }\n", "s");
  const Scene scene = build_scene(spec, folder.path());
  const Object told = believed(scene.objects[0]);
  EXPECT_LE(told.mesh.triangles.size(), other.triangles.size() / 4);
  EXPECT_EQ(told.world_from_object[3], glm::dvec4(1, 2, 3, 1));
  // A capture folder's scene brings the believed mesh along.
  const SceneSpec copy = write_self_contained(spec, scene, folder.path(), folder / "copy");
  EXPECT_EQ(copy.meshes[0].believed.file, "meshes/believed1.ply");
  const Object read = believed(load_scene(folder / "copy/scene.toml").objects[0]);
  EXPECT_EQ(read.mesh.positions, told.mesh.positions);
}

TEST(Believed, ACameraByHand) {
  const Scene scene = scene_of(mesh + camera +
                               "believed = { rotate_deg = [0, 0, 90], translate = [0, 0, 0.5], focal_px = "
                               "[1, 2], center_px = [3, -4] }\n");
  const Device truth = scene.cameras[0].device, told = believed_device(scene.cameras[0]);
  EXPECT_EQ(told.intrinsics.fx, truth.intrinsics.fx + 1);
  EXPECT_EQ(told.intrinsics.fy, truth.intrinsics.fy + 2);
  EXPECT_EQ(told.intrinsics.cx, truth.intrinsics.cx + 3);
  EXPECT_EQ(told.intrinsics.cy, truth.intrinsics.cy - 4);
  const glm::dvec3 x(0.3, -0.2, 0.7), y = apply(truth.device_from_world, x);
  EXPECT_LT(glm::distance(apply(told.device_from_world, x), glm::dvec3(-y.y, y.x, y.z + 0.5)), 1e-14);
}

// A turn by w about the camera's centre moves t by w×t; checked by moving the pose.
TEST(Believed, CovarianceIsThatOfAMovedPose) {
  const Scene scene = scene_of(mesh + camera +
                               "lens = { model = \"LENSMODEL_OPENCV4\", parameters = [0.1, 0, 0, 0] }\n"
                               "believed = { sigma_rotate_deg = [0, 1e-4, 0], sigma_center_px = [2, 3] }\n");
  const auto c = told_covariance(scene, scene.cameras[0]);
  constexpr int p = 4 + 4 + 6;
  ASSERT_EQ(c.size(), std::size_t(p * p));
  EXPECT_EQ(c[2 * p + 2], 4);
  EXPECT_EQ(c[3 * p + 3], 9);
  EXPECT_EQ(c[4 * p + 4], 0);  // the lens is certain
  Camera moved = scene.cameras[0];
  moved.belief.rotate_deg = moved.belief.sigma_rotate_deg;
  const glm::dvec3 dt =
      believed_device(moved).device_from_world.translation - moved.device.device_from_world.translation;
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(std::sqrt(c[(p - 3 + i) * (p + 1)]), std::abs(dt[i]), 1e-11);  // second order in 2e-6
}

TEST(Believed, EveryKeySurvivesWritingAndReading) {
  SceneSpec spec = parse_scene(mesh + camera, "s");
  spec.believe_truth = true;
  spec.meshes[0].believed = {"x.ply", 0.5, 0.001, 9, 1.01, {1, 2, 3}, {0.1, 0.2, 0.3}};
  spec.cameras[0].believed = {{1, 2, 3}, {0.1, 0.2, 0.3}, {1, 2},   {3, 4},
                              {5, 6, 7}, {8, 9, 10},      {11, 12}, {13, 14}};
  const std::string text = scene_toml(spec);
  EXPECT_EQ(parse_scene(text, "s"), spec) << text;
}

TEST(Believed, BadInputIsNamed) {
  EXPECT_THAT(error_of(mesh + "believed = { scael = 2 }\n"),
              HasSubstr("unknown key \"scael\" in believed of [[mesh]], did you mean \"scale\"?"));
  EXPECT_THAT(error_of(mesh + "believed = { scale = 0 }\n"), HasSubstr("scale in believed of [[mesh]] is 0"));
  EXPECT_THAT(error_of(mesh + "believed = { keep = 1.5 }\n"), HasSubstr("above 0 and at most 1"));
  EXPECT_THAT(error_of(mesh + "believed = { noise_sigma_m = -1 }\n"), HasSubstr("noise_sigma_m"));
  EXPECT_THAT(error_of(mesh + "believed = { file = \"none.ply\" }\n"),
              ::testing::AllOf(HasSubstr("[[mesh]] \"relief\": believed"), HasSubstr("none.ply")));
  EXPECT_THAT(error_of(mesh + camera + "believed = { sigma_translate = [0, 0, -1] }\n"),
              HasSubstr("sigma_translate in believed of [[camera]]"));
  EXPECT_THAT(error_of(mesh + camera + "believed = { focal_px = [-600, 0] }\n"),
              ::testing::AllOf(HasSubstr("[[camera]]"), HasSubstr("believed")));
}

}  // namespace
}  // namespace laterna
