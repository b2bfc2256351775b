// Scenes end to end, in memory.
#include "apps/lab/trial.h"

#include "sim/parallel.h"
#include "sim/scene_file.h"
#include "sim/shapes.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;

const std::filesystem::path scenes = laterna::testing::data_folder() / "scenes";

std::vector<ProjectorOutcome> run(const Scene& scene, const TrialOptions& options = {}) {
  StageTimes times;
  return run_trial(scene, trace(scene, times), options, times);
}

// A relief seen at a tenth of the usual cost.
Scene small_scene(const char* mesh = "shape = \"relief\"\nshape_size = [1.6, 1.0, 0.7]\nseed = 7",
                  const char* projector = "") {
  const std::string text =
      std::string("[[mesh]]\n") + mesh +
      "\n[[projector]]\nname = \"left\"\nsize = [320, 200]\nthrow_ratio = 1.2\nlens_shift = [0.0, 0.1]\n"
      "position = [0.35, -0.1, 2.1]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n" +
      projector +
      "\n[[camera]]\nsize = [400, 250]\nfov_x_deg = 42\nposition = [-0.35, 0.15, 2.0]\nlook_at = [0, 0, 0]\n"
      "up = [0.1, 1, 0]\n";
  return build_scene(parse_scene(text, "small.toml"), ".");
}

void expect_recovered_from_true_uv(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  TrialOptions options;
  options.true_uv = true;
  for (const ProjectorOutcome& o : run(load_scene(file), options)) {
    EXPECT_EQ(o.solve.status, Status::ok) << o.solve.reason;
    EXPECT_LE(o.verification.volume.rms, 1e-6);  // the bound: double all the way
    EXPECT_LE(o.verification.surface.rms, 1e-6);
    EXPECT_EQ(o.verification.volume.points, 16u * 12 * 12);
  }
}

// Gray codes round to whole pixels; the clustered prediction is an estimate of that error's effect: three
// times it is beyond chance for a sum of 10 squared parameters.
void expect_gray_within_three_predictions(const std::filesystem::path& file, double bound_px) {
  for (const ProjectorOutcome& o : run(load_scene(file))) {
    EXPECT_EQ(o.solve.status, Status::ok) << o.solve.reason;
    EXPECT_LE(o.verification.volume.rms, 3 * o.verification.volume.predicted_rms);
    EXPECT_LE(o.verification.volume.rms, bound_px);
    EXPECT_GT(o.correspondences, 50000u);
  }
}

TEST(Trial, ReliefFromTrueUv) { expect_recovered_from_true_uv(scenes / "relief.toml"); }

TEST(Trial, ReliefFromGrayCode) {
  for (const ProjectorOutcome& o : run(load_scene(scenes / "relief.toml"))) {
    EXPECT_LT(o.verification.volume.predicted_rms, 0.01);  // what the scene was made for
  }
  expect_gray_within_three_predictions(scenes / "relief.toml", 0.015);
}

TEST(Trial, HouseFromTrueUv) {
  if (!std::filesystem::exists("/usr/share/assimp/models/IFC/AC14-FZK-Haus.ifc"))
    GTEST_SKIP() << "assimp-testmodels is not installed";
  expect_recovered_from_true_uv(scenes / "house.toml");
}

TEST(Trial, HouseFromGrayCode) {
  if (!std::filesystem::exists("/usr/share/assimp/models/IFC/AC14-FZK-Haus.ifc"))
    GTEST_SKIP() << "assimp-testmodels is not installed";
  expect_gray_within_three_predictions(scenes / "house.toml", 0.5);
}

TEST(Trial, DragonFromTrueUv) {
  if (!std::filesystem::exists(scenes / "../fetched/stanford-dragon"))
    GTEST_SKIP() << "the dragon scan was not fetched";
  expect_recovered_from_true_uv(scenes / "dragon.toml");
}

TEST(Trial, DragonFromGrayCode) {
  if (!std::filesystem::exists(scenes / "../fetched/stanford-dragon"))
    GTEST_SKIP() << "the dragon scan was not fetched";
  expect_gray_within_three_predictions(scenes / "dragon.toml", 0.5);
}

TEST(Trial, LensIsRecoveredWithTheProjector) {
  TrialOptions options;
  options.true_uv = true;
  const Scene scene =
      small_scene("shape = \"relief\"\nshape_size = [1.6, 1.0, 0.7]\nseed = 7",
                  "lens = { model = \"LENSMODEL_OPENCV4\", parameters = [-0.08, 0.03, 0.002, -0.001] }");
  const ProjectorOutcome o = run(scene, options).at(0);
  EXPECT_EQ(o.solve.status, Status::ok) << o.solve.reason;
  EXPECT_LE(o.verification.surface.rms, 1e-6);  // as without a lens
  EXPECT_NEAR(o.solve.estimate.lens.parameters[0], -0.08, 1e-6);
}

TEST(Trial, NoiseOnTheSensorIsSurvived) {
  Scene scene = small_scene();
  scene.cameras[0].sensor.noise_sigma_dn = 2;
  const ProjectorOutcome o = run(scene).at(0);
  EXPECT_EQ(o.solve.status, Status::ok) << o.solve.reason;
  EXPECT_LE(o.verification.volume.rms, 3 * o.verification.volume.predicted_rms);
}

TEST(Trial, SeveralProjectorsAndCamerasEachGetAnAnswer) {
  Scene scene = small_scene();
  Projector right = scene.projectors[0];
  right.device.name = "right";
  right.device.device_from_world = device_from_world_looking_at({-0.4, 0.2, 2.3}, {0, 0, 0}, {0, 1, 0});
  Camera second = scene.cameras[0];
  second.device.name = "second";
  second.device.device_from_world = device_from_world_looking_at({0.5, 0.4, 2.0}, {0, 0, 0}, {0, 1, 0});
  scene.projectors.push_back(right);
  scene.cameras.push_back(second);
  const auto outcomes = run(scene);
  ASSERT_EQ(outcomes.size(), 2u);
  EXPECT_EQ(outcomes[1].name, "right");
  for (const ProjectorOutcome& o : outcomes) {
    EXPECT_EQ(o.solve.status, Status::ok) << o.solve.reason;
    EXPECT_LE(o.verification.volume.rms, 3 * o.verification.volume.predicted_rms);
    EXPECT_GT(o.correspondences, 60000u);  // two cameras of 100,000 pixels each
  }
}

TEST(Trial, SameBitsForAnyNumberOfThreads) {
  Scene scene = small_scene();
  scene.cameras[0].sensor.noise_sigma_dn = 1;
  std::vector<double> seen;
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    const ProjectorOutcome o = run(scene).at(0);
    seen.push_back(o.verification.volume.rms + o.solve.estimate.intrinsics.fx + o.solve.sigma[0]);
  }
  set_thread_count(0);
  EXPECT_EQ(seen[0], seen[1]);
  EXPECT_EQ(seen[0], seen[2]);
}

TEST(Trial, APlaneIsRefused) {
  const ProjectorOutcome o = run(small_scene("shape = \"plane\"\nshape_size = [1.6, 1.0, 1.0]")).at(0);
  EXPECT_EQ(o.solve.status, Status::refused);
  EXPECT_THAT(o.solve.reason, HasSubstr("plane"));
}

TEST(Trial, NoOverlapIsRefused) {
  Scene scene = small_scene();
  scene.projectors[0].device.device_from_world =
      device_from_world_looking_at({0.35, -0.1, 2.1}, {0, 0, 5}, {0, 1, 0});
  const ProjectorOutcome o = run(scene).at(0);
  EXPECT_EQ(o.solve.status, Status::refused);
  EXPECT_THAT(o.solve.reason, HasSubstr("no overlap"));
}

TEST(Trial, ThinReliefIsNeverSilentlyWrong) {
  for (const char* depth : {"0.1", "0.01", "0.001", "0.0001", "0.00001"}) {
    const std::string mesh = std::string("shape = \"relief\"\nshape_size = [1.6, 1.0, ") + depth + "]";
    const ProjectorOutcome o = run(small_scene(mesh.c_str())).at(0);
    if (o.solve.status != Status::ok) continue;
    EXPECT_LE(o.verification.volume.rms, 5 * o.verification.volume.predicted_rms) << depth;
  }
}

TEST(Trial, ASceneWithoutDevicesIsBadInput) {
  Scene scene = small_scene();
  scene.projectors.clear();
  EXPECT_THAT(testing::input_error([&] { run(scene); }), HasSubstr("[[projector]]"));
  scene = small_scene();
  scene.cameras.clear();
  EXPECT_THAT(testing::input_error([&] { run(scene); }), HasSubstr("[[camera]]"));
}

TEST(Trial, ExitCodeIsTheWorst) {
  std::vector<ProjectorOutcome> outcomes(2);
  outcomes[0].solve.status = outcomes[1].solve.status = Status::ok;
  EXPECT_EQ(exit_code_of(outcomes), 0);
  outcomes[1].solve.status = Status::weak;
  EXPECT_EQ(exit_code_of(outcomes), 4);
  outcomes[0].solve.status = Status::refused;
  EXPECT_EQ(exit_code_of(outcomes), 3);
}

}  // namespace
}  // namespace laterna
