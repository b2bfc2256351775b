#include "calib/peers/board_methods.h"

#include "sim/error.h"
#include "tests/calib/boards/synthetic_boards.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>

namespace laterna {
namespace {

using ::testing::HasSubstr;

std::string refusal_of(BoardRig (*solve)(const BoardCapture&, const RigModel&),
                       const testing::BoardTruth& t) {
  try {
    solve(t.capture, t.model);
  } catch (const Refusal& refusal) {
    return refusal.what();
  }
  return "";
}

testing::BoardTruth noisy_opencv4(std::mt19937_64& random) {
  testing::BoardScene scene;
  scene.camera_terms = scene.projector_terms = lens_terms("opencv4");
  scene.camera_lens = {-0.2, 0.05, 0.001, -0.001};
  scene.projector_lens = {-0.06, 0.02, 0.002, 0.001};
  testing::BoardTruth t = testing::board_truth(scene, random);
  t.capture = testing::with_noise(t.capture, random);
  return t;
}

TEST(BoardMethods, MrcalEndsWhereTheJointAdjustmentEnds) {
  auto random = testing::generator();
  auto t = noisy_opencv4(random);
  for (const bool bend : {false, true}) {
    t.model.bend = bend;
    const BoardRig mrcal = solve_mrcal(t.capture, t.model);
    const auto joint = adjust({t.capture, t.model}, mrcal);
    ASSERT_TRUE(joint && joint->converged);
    const RigProblem problem(t.capture, t.model);
    double most = 0;
    for (const Sighting& s : problem.sightings) {
      double a[2], b[2];
      ASSERT_TRUE(predict(problem, mrcal, s, a, nullptr) && predict(problem, joint->rig, s, b, nullptr));
      most = std::max(most, std::hypot(a[0] - b[0], a[1] - b[1]));
    }
    EXPECT_LT(most, 1e-3);  // mrcal stops at its own thresholds; noise is 0.1 to 0.2 px
  }
}

TEST(BoardMethods, EveryMethodRunsOnTheSameSightings) {
  auto random = testing::generator();
  const auto t = noisy_opencv4(random);
  const auto results = compare_board_methods(t.capture, t.model);
  ASSERT_EQ(results.size(), board_methods().size());
  for (const MethodResult& r : results) {
    ASSERT_TRUE(r.rig) << r.name << ": " << r.failure;
    EXPECT_GT(r.seconds, 0);
    EXPECT_EQ(r.held_out.folds.size() + r.held_out.failed.size(), 6u);
    EXPECT_LT(r.fit_rms_px[1], 3) << r.name;  // stepwise pays for its poses, but nobody is lost
    EXPECT_NEAR(r.rig->devices[1].parameters[3], 860, 100) << r.name;
  }
  for (const MethodResult& r :
       results)  // least squares: nobody fits better than the joint optimum, all in all
    EXPECT_GE(std::hypot(r.fit_rms_px[0] / 0.1, r.fit_rms_px[1] / 0.2),
              std::hypot(results[0].fit_rms_px[0] / 0.1, results[0].fit_rms_px[1] / 0.2) - 0.02);
}

TEST(BoardMethods, SayWhatTheyCannotTake) {
  auto random = testing::generator();
  auto t = noisy_opencv4(random);
  t.model.devices[1] = model_of_terms({"k1"});
  EXPECT_THAT(refusal_of(solve_mrcal, t), HasSubstr("one whole lens model"));
  EXPECT_THAT(refusal_of(solve_opencv_joint, t), HasSubstr("one lens model"));
  t.model.bend = true;
  EXPECT_THAT(refusal_of(solve_opencv_stepwise, t), HasSubstr("no bend"));
  auto irregular = noisy_opencv4(random);
  irregular.capture.sightings[3].x_board.x += 0.01;
  EXPECT_THAT(refusal_of(solve_mrcal, irregular), HasSubstr("regular grid"));
}

}  // namespace
}  // namespace laterna
