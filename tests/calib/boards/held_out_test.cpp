#include "calib/boards/held_out.h"

#include "calib/boards/stepwise.h"
#include "tests/calib/boards/synthetic_boards.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>

namespace laterna {
namespace {

TEST(HeldOut, CleanDataAreForecastExactly) {
  auto random = testing::generator();
  const auto t = testing::board_truth({}, random);
  const HeldOut h = hold_out_poses(t.capture, t.model, t.rig);
  ASSERT_EQ(h.folds.size(), 6u);
  EXPECT_TRUE(h.failed.empty());
  EXPECT_LT(h.rms_px, 1e-6);  // convergence from the truth; weak directions amplify rounding
}

// With the true rig in every fold the error is the projector's noise and that of the board's pose from the
// camera alone.
TEST(HeldOut, TheTruthForecastsToTheNoise) {
  auto random = testing::generator();
  testing::BoardScene scene;
  scene.camera_sigma_px = 1e-4;  // so that the pose is as good as known
  scene.projector_sigma_px = 0.2;
  const auto t = testing::board_truth(scene, random);
  const BoardCapture noisy = testing::with_noise(t.capture, random);
  const HeldOut h = hold_out_poses(noisy, t.model, t.rig, [](const BoardCapture&, const BoardRig& start) {
    return std::optional<BoardRig>(start);
  });
  EXPECT_NEAR(h.rms_px / (0.2 * std::sqrt(2.0)), 1,
              0.12);  // rms of some 700 deviates: 3 % each way, four sigma
  double sum = 0, count = 0;
  for (const HeldOutPose& fold : h.folds)
    sum += fold.rms_px * fold.rms_px * double(fold.sightings), count += double(fold.sightings);
  EXPECT_NEAR(h.rms_px, std::sqrt(sum / count), 1e-12);  // DESIGN's pooled rms
}

TEST(HeldOut, TheFoldNeverSeesItsPose) {
  auto random = testing::generator();
  const auto t = testing::board_truth({}, random);
  const HeldOut h =
      hold_out_poses(t.capture, t.model, t.rig, [&](const BoardCapture& others, const BoardRig& start) {
        EXPECT_EQ(others.pose_count(), 5);
        EXPECT_EQ(start.camera_from_board.size(), 5u);
        return std::optional<BoardRig>(start);
      });
  EXPECT_EQ(h.folds.size(), 6u);
}

TEST(HeldOut, FailedFoldsAreNamed) {
  auto random = testing::generator();
  const auto t = testing::board_truth({}, random);
  const HeldOut h =
      hold_out_poses(t.capture, t.model, t.rig,
                     [](const BoardCapture& others, const BoardRig& start) -> std::optional<BoardRig> {
                       if (others.pose_labels[0] == 1) return std::nullopt;  // without pose 0
                       return start;
                     });
  EXPECT_EQ(h.failed, std::vector<int>{0});
  EXPECT_EQ(h.folds.size(), 5u);
}

// Camera noise goes into stepwise poses, and from there into the projector. Median over random rigs.
TEST(HeldOut, JointForecastsBetterThanStepwise) {
  auto random = testing::generator();
  std::vector<double> ratios;
  for (int i = 0; i < 15; ++i) {
    testing::BoardScene scene;
    scene.poses = 5;
    scene.camera_sigma_px = 0.3, scene.projector_sigma_px = 0.1;
    const auto t = testing::board_truth(scene, random);
    const BoardCapture noisy = testing::with_noise(t.capture, random);
    const HeldOut joint = hold_out_poses(noisy, t.model, t.rig);
    const HeldOut stepwise =
        hold_out_poses(noisy, t.model, t.rig, [&](const BoardCapture& others, const BoardRig& start) {
          return adjust_stepwise(others, t.model, start);
        });
    if (joint.failed.empty() && stepwise.failed.empty()) ratios.push_back(joint.rms_px / stepwise.rms_px);
  }
  ASSERT_GE(ratios.size(), 10u);
  std::nth_element(ratios.begin(), ratios.begin() + std::ptrdiff_t(ratios.size() / 2), ratios.end());
  EXPECT_LT(ratios[ratios.size() / 2], 1);
}

// A board that is bent by 1 mm over half a metre: the flat model pays, the bent one forecasts to the noise.
TEST(HeldOut, TheBendModelRepairsABentBoard) {
  auto random = testing::generator();
  testing::BoardScene scene;
  scene.bend = {0.0010, 0.0006};
  const auto t = testing::board_truth(scene, random);
  const BoardCapture noisy = testing::with_noise(t.capture, random);
  RigModel bent = t.model;
  bent.bend = true;
  BoardRig flat_start = t.rig;
  flat_start.bend = glm::dvec2(0.0);
  const auto fit = fit_rig(noisy, bent, flat_start, false);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->adjustment.rig.bend.x, 0.0010, 0.0002);  // some four sigma
  const HeldOut with = hold_out_poses(noisy, bent, fit->adjustment.rig);
  const HeldOut without = hold_out_poses(noisy, t.model, flat_start);
  EXPECT_LT(with.rms_px, 0.8 * without.rms_px);
}

}  // namespace
}  // namespace laterna
