// What the solver believes beside what was rendered, end to end.
#include "apps/lab/told_points.h"

#include "apps/lab/calibrate_folder.h"
#include "apps/lab/capture_writer.h"
#include "apps/lab/trial.h"
#include "sim/capture_folder.h"
#include "sim/scene_file.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

namespace laterna {
namespace {

using ::testing::HasSubstr;

const std::string relief =
    "[[mesh]]\nname = \"relief\"\nshape = \"relief\"\nshape_size = [1.6, 1.0, 0.5]\nseed = 7\n";
const std::string ball =
    "[[mesh]]\nname = \"ball\"\nshape = \"sphere\"\nshape_size = [0.35, 0.35, 0.35]\ntranslate = [0.1, 0.05, "
    "0.4]\n";
const std::string projector =
    "[[projector]]\nname = \"left\"\nsize = [320, 200]\nthrow_ratio = 1.2\nlens_shift = [0.0, 0.1]\n"
    "position = [0.35, -0.1, 2.1]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n";
const std::string right =
    "[[projector]]\nname = \"right\"\nsize = [320, 200]\nthrow_ratio = 1.3\nposition = [-0.4, 0.2, 2.3]\n"
    "look_at = [0, 0, 0]\nup = [0, 1, 0]\n";
const std::string camera =
    "[[camera]]\nsize = [400, 250]\nfov_x_deg = 42\nposition = [-0.35, 0.15, 2.0]\nlook_at = [0, 0, 0]\n"
    "up = [0.1, 1, 0]\n";

Scene scene_of(const std::string& text) { return build_scene(parse_scene(text, "s"), "."); }

std::vector<ProjectorOutcome> run(const Scene& scene) {
  StageTimes times;
  return run_trial(scene, trace(scene, times), {}, times);
}

bool same_points(const PixelArray<glm::dvec3>& a, const PixelArray<glm::dvec3>& b) {
  return a.values.size() == b.values.size() &&
         std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(glm::dvec3)) == 0;
}

TEST(ToldPoints, WithoutBeliefsTheyAreTheTrueOnes) {
  const Scene scene = scene_of(relief + ball + projector + camera);
  StageTimes times;
  const Traced traced = trace(scene, times);
  const auto told = told_points(scene, traced);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_TRUE(same_points(told[0].points_world, traced.points_world[0]));
  EXPECT_TRUE(told[0].normals_world.values.empty());
  EXPECT_TRUE(told_cameras(scene).empty());
  EXPECT_TRUE(same_points(ToldScene(scene).trace(0).points_world, traced.points_world[0]));
}

// Believed a tenth of a metre nearer to a camera that looks straight down: so are the points; and a mesh that
// is believed elsewhere altogether is seen by nobody.
TEST(ToldPoints, FollowTheBelievedMesh) {
  const std::string down =
      "[[camera]]\nsize = [40, 30]\nfov_x_deg = 20\nposition = [0, 0, 2]\nlook_at = [0, 0, 0]\nup = [0, 1, "
      "0]\n";
  const std::string plane = "[[mesh]]\nshape = \"plane\"\nshape_size = [4, 4, 1]\n";
  const ToldScene nearer(scene_of(plane + "believed = { translate = [0, 0, 0.1] }\n" + projector + down));
  for (const glm::dvec3& x : nearer.trace(0).points_world.values) EXPECT_NEAR(x.z, 0.1, 1e-12);
  const Scene away = scene_of(plane + "believed = { translate = [50, 0, 0] }\n" + projector + down);
  EXPECT_TRUE(std::isnan(ToldScene(away).trace(0).points_world.values[0].x));
  const ProjectorOutcome o = run(away).at(0);
  EXPECT_EQ(o.solve.status, Status::refused);
  EXPECT_EQ(o.correspondences, 0u);
}

TEST(ToldPoints, SigmasAloneLeaveTheEstimateAndWidenThePrediction) {
  const std::string text = relief + projector + camera;
  const ProjectorOutcome plain = run(scene_of(text)).at(0);
  const ProjectorOutcome told =
      run(scene_of(text + "believed = { sigma_translate = [0.001, 0.001, 0.001] }\n")).at(0);
  const ProjectorOutcome off = run(scene_of("believe_truth = true\n" + text +
                                            "believed = { sigma_translate = [0.001, 0.001, 0.001] }\n"))
                                   .at(0);
  EXPECT_EQ(off.solve.covariance, plain.solve.covariance);
  EXPECT_EQ(told.solve.estimate.intrinsics.fx, plain.solve.estimate.intrinsics.fx);
  EXPECT_TRUE(plain.solve.covariance_camera.empty());
  EXPECT_GT(told.solve.predicted_volume_rms_camera_px, 0);
  EXPECT_GT(told.solve.predicted_volume_rms_px, plain.solve.predicted_volume_rms_px);
  EXPECT_GT(told.verification.volume.predicted_rms, plain.verification.volume.predicted_rms);
}

// A camera that stands where its sigmas allow: the error that follows is the one predicted. Were one
// direction to make it all, the rms of six ratios would scatter by 1/√12 = 29 %: a factor of two is beyond
// chance. The residuals are explained too, to the sigma of Gray codes: below it, edges between facets show.
TEST(ToldPoints, ErrorsOfDrawnCamerasAreThosePredicted) {
  auto random = testing::generator();
  std::normal_distribution<double> normal;
  double sum2 = 0;
  constexpr int draws = 6;
  for (int k = 0; k < draws; ++k) {
    Scene scene = scene_of(relief + projector + camera);
    CameraBelief& b = scene.cameras[0].belief;
    b.sigma_rotate_deg = glm::dvec3(0.02), b.sigma_translate = glm::dvec3(0.001);
    b.sigma_focal_px = b.sigma_center_px = glm::dvec2(0.3);
    for (int i = 0; i < 3; ++i)
      b.rotate_deg[i] = 0.02 * normal(random), b.translate[i] = 0.001 * normal(random);
    for (int i = 0; i < 2; ++i) b.focal_px[i] = 0.3 * normal(random), b.center_px[i] = 0.3 * normal(random);
    const ProjectorOutcome o = run(scene).at(0);
    ASSERT_NE(o.solve.status, Status::refused) << o.solve.reason;
    EXPECT_THAT(o.solve.reason, ::testing::Not(HasSubstr("residual")));  // the sigmas explain them
    EXPECT_GT(o.solve.predicted_volume_rms_camera_px, 10 * o.solve.predicted_volume_rms_independent_px);
    sum2 += std::pow(o.verification.volume.rms / o.verification.volume.predicted_rms, 2);
  }
  const double ratio = std::sqrt(sum2 / draws);
  RecordProperty("error_over_prediction", std::to_string(ratio));
  EXPECT_GT(ratio, 0.5);
  EXPECT_LT(ratio, 2);
}

// What the residuals of Gray codes tell of a wrong belief, and what they do not. The error is the true one.
struct Case {
  const char* what;
  std::string mesh, ball, camera;  // lines of `believed`
  bool seen;                       // ends as weak
};

TEST(ToldPoints, WhatIsSeenAndWhatIsNot) {
  // Whole world and camera moved together: no pixel knows. The camera's frame moves against the world's.
  const Scene truth = scene_of(relief + ball + projector + camera);
  const glm::dvec3 step(0.05, 0.02, -0.03);
  const glm::dvec3 against = -(truth.cameras[0].device.device_from_world.rotation * step);
  const std::string all_moved = "translate = [0.05, 0.02, -0.03]";
  const std::string camera_moved =
      fmt::format("translate = [{:.15f}, {:.15f}, {:.15f}]", against.x, against.y, against.z);
  const std::vector<Case> cases = {
      {"truth", "", "", "", false},
      {"world and camera moved together", all_moved, all_moved, camera_moved, false},
      {"noise of 0.1 mm", "noise_sigma_m = 0.0001", "", "", false},
      {"noise of 10 mm", "noise_sigma_m = 0.01", "", "", false},
      {"noise of 20 mm", "noise_sigma_m = 0.02", "", "", true},
      {"a tenth of the triangles", "keep = 0.1", "", "", false},
      {"a hundredth of the triangles", "keep = 0.01", "", "", true},
      {"one of two objects misplaced by 50 mm", "", "translate = [0.05, 0, 0]", "", true},
      {"all enlarged by 1 % about the origin", "scale = 1.01",
       "scale = 1.01, translate = [0.001, 0.0005, 0.004]", "", true},
      {"camera misplaced by 5 mm", "", "", "translate = [0.005, 0, 0]", true},
      {"camera misplaced by 1 mm", "", "", "translate = [0.001, 0, 0]", false},
      {"camera's focal length off by 1 %", "", "", "focal_px = [5, 5]", true},
  };
  for (const Case& c : cases) {
    const auto belief = [](const std::string& lines) {
      return lines.empty() ? std::string() : "believed = { " + lines + " }\n";
    };
    const Scene scene =
        scene_of(relief + belief(c.mesh) + ball + belief(c.ball) + projector + camera + belief(c.camera));
    const ProjectorOutcome o = run(scene).at(0);
    fmt::print("{:<38} {:<5} residuals {:6.2f} × sigma, error {:8.3f} px, predicted {:7.3f}\n", c.what,
               o.solve.status == Status::ok ? "ok" : "weak", o.solve.residual_scale,
               o.verification.volume.rms, o.verification.volume.predicted_rms);
    EXPECT_EQ(o.solve.status == Status::weak, c.seen) << c.what << ": " << o.solve.reason;
  }
}

TEST(ToldPoints, TwoProjectorsWithBeliefs) {
  const Scene scene =
      scene_of(relief + "believed = { noise_sigma_m = 0.0002, keep = 0.9 }\n" + projector + right + camera +
               "believed = { translate = [0.001, 0, 0], sigma_translate = [0.001, 0.001, "
               "0.001] }\n");
  const auto outcomes = run(scene);
  ASSERT_EQ(outcomes.size(), 2u);
  for (const ProjectorOutcome& o : outcomes) {
    EXPECT_NE(o.solve.status, Status::refused) << o.solve.reason;
    EXPECT_GT(o.correspondences, 30000u);
    EXPECT_LT(o.verification.volume.rms, 3 * o.verification.volume.predicted_rms);  // three sigmas
  }
}

// A capture folder holds truth and beliefs; calibrate takes the beliefs, and so finds what the round trip
// does.
TEST(ToldPoints, CalibrateTakesTheBelievedOnes) {
  const testing::ScratchFolder folder;
  const std::string text =
      relief + "believed = { noise_sigma_m = 0.001 }\n" + projector + camera +
      "believed = { translate = [0.002, 0, 0], sigma_translate = [0.002, 0.002, 0.002] }\n";
  const SceneSpec spec = parse_scene(text, "s");
  const Scene scene = build_scene(spec, ".");
  const ProjectorOutcome there = run(scene).at(0);
  StageTimes times;
  write_capture(spec, scene, ".", folder / "capture", {}, times);
  const std::vector<FolderEstimate> estimates =
      calibrate_folder(folder / "capture", read_manifest(folder / "capture"),
                       load_scene(folder / "capture/scene.toml"), {}, {});
  ASSERT_EQ(estimates.size(), 1u);
  EXPECT_EQ(estimates[0].correspondences, there.correspondences);
  EXPECT_EQ(estimates[0].solve.estimate.intrinsics.fx, there.solve.estimate.intrinsics.fx);
  EXPECT_EQ(estimates[0].solve.covariance, there.solve.covariance);
}

}  // namespace
}  // namespace laterna
