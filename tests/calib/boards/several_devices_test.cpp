// Two cameras, or two projectors, adjusted jointly with the first of each.
#include "calib/boards/calibrate_boards.h"

#include "tests/calib/boards/board_trials.h"
#include "tests/testing.h"

namespace laterna {
namespace {

testing::BoardScene two_cameras() {
  testing::BoardScene scene;
  scene.second_camera = true;
  return scene;
}

testing::BoardScene two_projectors() {
  testing::BoardScene scene;
  scene.second_projector = true;
  return scene;
}

// 50 random rigs within the 99.7 % quantile of their covariance, 0.15 outside expected; three or more: p =
// 5e-4. Their mean eᵀC⁻¹e over the number of parameters scatters by sqrt(2/(50·20)), 0.045; four times that.
void expect_honest_covariance(const testing::BoardScene& scene) {
  auto random = testing::generator();
  int inside = 0;
  double share = 0;
  for (int i = 0; i < 50; ++i) {
    const auto e = testing::random_rig_error(scene, random);
    ASSERT_TRUE(e);
    inside += e->squared < testing::chi2_997(e->parameters);
    share += e->squared / e->parameters / 50;
  }
  EXPECT_GE(inside, 48);
  EXPECT_NEAR(share, 1, 0.18);
}

// From pixels alone: starts of their own, sigmas of the residuals, lenses given. Every parameter within five
// of its sigmas, which is beyond chance for some thirty.
void expect_calibrated(const testing::BoardScene& scene) {
  auto random = testing::generator();
  const auto t = testing::board_truth(scene, random);
  BoardOptions options;
  options.terms.assign(t.rig.devices.size(), {});
  const BoardCalibration c = calibrate_boards(testing::with_noise(t.capture, random), options);
  ASSERT_NE(c.status, Status::refused) << c.reason;
  ASSERT_EQ(c.devices.size(), t.rig.devices.size());
  const auto step = global_step(c.ladder.fit.adjustment.rig, t.rig, columns_of(c.ladder.fit.model));
  for (std::size_t i = 0; i < step.size(); ++i)
    EXPECT_LT(std::abs(step[i]), 5 * c.sigma[i]) << c.parameter_names[i];
  EXPECT_EQ(c.held_out().folds.size(), std::size_t(scene.poses));
}

// How sure the last parameters of device 1 are, its place.
double place_sigma(const testing::BoardTruth& t, bool with_second) {
  testing::BoardTruth fewer = t;
  if (!with_second) {
    fewer.capture.devices.resize(2), fewer.rig.devices.resize(2), fewer.model.devices.resize(2);
    std::erase_if(fewer.capture.sightings, [](const Sighting& s) { return s.device > 1; });
  }
  const auto c = testing::true_covariance(fewer);
  EXPECT_TRUE(c);
  const int at = columns_of(fewer.model).devices[1].pose;
  double sum = 0;
  for (int i = at; i < at + 6; ++i) sum += c->global[i * c->globals + i];
  return std::sqrt(sum);
}

}  // namespace

TEST(SeveralDevices, TwoCamerasLieWithinTheirCovariance) { expect_honest_covariance(two_cameras()); }

TEST(SeveralDevices, TwoProjectorsLieWithinTheirCovariance) { expect_honest_covariance(two_projectors()); }

TEST(SeveralDevices, TwoCamerasAreCalibratedFromPixelsAlone) { expect_calibrated(two_cameras()); }

TEST(SeveralDevices, TwoProjectorsAreCalibratedFromPixelsAlone) { expect_calibrated(two_projectors()); }

TEST(SeveralDevices, ASecondCameraMakesTheProjectorSurer) {
  auto random = testing::generator();
  const auto t = testing::board_truth(two_cameras(), random);
  EXPECT_LT(place_sigma(t, true), place_sigma(t, false));
}

// Poses 0 to 3 before both cameras, 4 and 5 before the second one alone.
BoardCapture partly_seen(const testing::BoardTruth& t, std::mt19937_64& random) {
  BoardCapture capture = testing::with_noise(t.capture, random);
  std::erase_if(capture.sightings, [](const Sighting& s) { return s.device == 0 && s.pose >= 4; });
  return capture;
}

TEST(SeveralDevices, APoseThatTheFirstCameraDoesNotSeeHangsOnAnother) {
  auto random = testing::generator();
  const auto t = testing::board_truth(two_cameras(), random);
  BoardOptions options;
  options.terms.assign(t.rig.devices.size(), {});
  const BoardCapture capture = partly_seen(t, random);
  const BoardCalibration all = calibrate_boards(capture, options);
  ASSERT_NE(all.status, Status::refused) << all.reason;
  EXPECT_TRUE(all.unused_poses.empty());
  EXPECT_EQ(all.held_out().folds.size(), 6u);
  const RigColumns columns = columns_of(all.ladder.fit.model);
  const auto step = global_step(all.ladder.fit.adjustment.rig, t.rig, columns);
  for (std::size_t i = 0; i < step.size(); ++i)
    EXPECT_LT(std::abs(step[i]), 5 * all.sigma[i]) << all.parameter_names[i];
  const BoardCalibration fewer = calibrate_boards(with_poses(capture, {0, 1, 2, 3}), options);
  ASSERT_NE(fewer.status, Status::refused) << fewer.reason;
  EXPECT_LT(all.sigma[columns.devices[2].intrinsics[0]], fewer.sigma[columns.devices[2].intrinsics[0]]);
}

TEST(SeveralDevices, ACameraThatSharesNoBoardWithTheOthersIsRefused) {
  auto random = testing::generator();
  const auto t = testing::board_truth(two_cameras(), random);
  BoardCapture capture = partly_seen(t, random);
  std::erase_if(capture.sightings, [](const Sighting& s) { return s.device > 0 && s.pose < 4; });
  const BoardCalibration c = calibrate_boards(capture);
  EXPECT_EQ(c.status, Status::refused);
  EXPECT_NE(c.reason.find("projector: "), std::string::npos) << c.reason;
}

// Held-out errors are of projector pixels: a second camera's own are not among them.
TEST(SeveralDevices, HeldOutCountsProjectorsAlone) {
  auto random = testing::generator();
  auto t = testing::board_truth(two_cameras(), random);
  const HeldOut held_out = hold_out_poses(t.capture, t.model, t.rig);
  ASSERT_EQ(held_out.folds.size(), t.rig.camera_from_board.size());
  for (const HeldOutPose& fold : held_out.folds) {
    const auto lit = std::count_if(t.capture.sightings.begin(), t.capture.sightings.end(),
                                   [&](const Sighting& s) { return s.device == 1 && s.pose == fold.pose; });
    EXPECT_EQ(fold.sightings, std::size_t(lit));
  }
}

}  // namespace laterna
