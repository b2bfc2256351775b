#include "calib/boards/lens_ladder.h"

#include "calib/boards/rig_start.h"
#include "sim/parallel.h"
#include "tests/calib/boards/synthetic_boards.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using Terms = std::vector<std::vector<std::string>>;

HeldOut folds_of(const std::vector<double>& rms) {
  HeldOut h;
  for (std::size_t k = 0; k < rms.size(); ++k) h.folds.push_back({int(k), rms[k], 10, {}});
  return h;
}

TEST(LensLadder, ThePairedGainIsAMeanOverItsStandardError) {
  // Logs of the ratios: ln 2 and ln 4: mean 1.5·ln 2, standard error ln 2/2.
  EXPECT_NEAR(paired_gain_over_error(folds_of({2, 4}), folds_of({1, 1})), 3, 1e-12);
  EXPECT_NEAR(paired_gain_over_error(folds_of({1, 1}), folds_of({2, 4})), -3, 1e-12);
  EXPECT_EQ(paired_gain_over_error(folds_of({2}), folds_of({1})), 0);
}

Ladder climbed(const testing::BoardTruth& t, std::mt19937_64& random, const LadderOptions& options = {}) {
  const BoardCapture noisy = testing::with_noise(t.capture, random);
  const RigStart start = start_rig(noisy);
  EXPECT_TRUE(start.rig) << start.refusal;
  return climb(noisy, *start.rig, true, options);
}

TEST(LensLadder, PinholesMostlyStayPinholes) {
  auto random = testing::generator();
  int terms = 0;
  for (int i = 0; i < 4; ++i) {
    testing::BoardScene scene;
    scene.poses = 8;
    const Ladder ladder = climbed(testing::board_truth(scene, random), random);
    for (const auto& t : ladder.rungs[ladder.winner].terms) terms += int(t.size());
  }
  EXPECT_LE(terms, 4);  // a rule of one standard error lets chance in now and then: never a term per device
}

TEST(LensLadder, DistortionThatCountsIsFoundOnTheDeviceThatHasIt) {
  auto random = testing::generator();
  testing::BoardScene scene;
  scene.poses = 8;
  scene.camera_terms = scene.projector_terms = {"k1"};
  scene.camera_lens = {-0.2, 0, 0, 0};
  scene.projector_lens = {0.08, 0, 0, 0};
  const auto t = testing::board_truth(scene, random);
  const Ladder ladder = climbed(t, random);
  const Rung& won = ladder.rungs[ladder.winner];
  EXPECT_THAT(won.terms[0], ::testing::Contains("k1"));
  EXPECT_THAT(won.terms[1], ::testing::Contains("k1"));
  EXPECT_NEAR(ladder.fit.adjustment.rig.devices[0].parameters[4], -0.2, 0.05);
  EXPECT_LT(won.held_out.rms_px, 0.4);  // the projector's noise is 0.28
  EXPECT_GT(ladder.rungs[0].held_out.rms_px, 2 * won.held_out.rms_px);
  EXPECT_TRUE(won.chosen);
}

TEST(LensLadder, ABentBoardIsFound) {
  auto random = testing::generator();
  testing::BoardScene scene;
  scene.poses = 8;
  scene.bend = {0.002, 0.001};
  const auto t = testing::board_truth(scene, random);
  const Ladder ladder = climbed(t, random);
  EXPECT_TRUE(ladder.rungs[ladder.winner].bend);
  EXPECT_NEAR(ladder.fit.adjustment.rig.bend.x, 0.002, 0.0004);  // some four sigma
  LadderOptions off;
  off.bend = LadderOptions::Bend::off;
  const Ladder flat = climbed(t, random, off);
  for (const Rung& rung : flat.rungs) EXPECT_FALSE(rung.bend);
}

TEST(LensLadder, TwoPosesLeaveNothingToTest) {
  auto random = testing::generator();
  testing::BoardScene scene;
  scene.poses = 2;
  const Ladder ladder = climbed(testing::board_truth(scene, random), random);
  EXPECT_EQ(ladder.rungs.size(), 1u);
}

TEST(LensLadder, SameBitsForAnyNumberOfThreads) {
  auto random = testing::generator();
  testing::BoardScene scene;
  scene.camera_terms = {"k1"};
  scene.camera_lens = {-0.2, 0, 0, 0};
  const auto t = testing::board_truth(scene, random);
  const BoardCapture noisy = testing::with_noise(t.capture, random);
  set_thread_count(1);
  const Ladder one = climb(noisy, *start_rig(noisy).rig, true);
  set_thread_count(5);
  const Ladder five = climb(noisy, *start_rig(noisy).rig, true);
  set_thread_count(0);
  EXPECT_EQ(one.fit.adjustment.rig.devices[1].parameters, five.fit.adjustment.rig.devices[1].parameters);
  EXPECT_EQ(one.rungs[one.winner].held_out.rms_px, five.rungs[five.winner].held_out.rms_px);
}

}  // namespace
}  // namespace laterna
