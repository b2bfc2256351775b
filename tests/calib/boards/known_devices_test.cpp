// Boards before devices whose intrinsics are known.
#include "calib/boards/known_devices.h"

#include "calib/boards/calibrate_boards.h"
#include "calib/boards/synthetic_boards.h"
#include "tests/calib/trials.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using testing::generator;
using ::testing::HasSubstr;

// With lenses, so that starts have to look through them.
synthetic::BoardScene scene_of(int poses) {
  synthetic::BoardScene scene;
  scene.poses = poses;
  scene.camera_terms = scene.projector_terms = lens_terms("k1k2p1p2");
  scene.camera_lens = {-0.12, 0.05, 0.001, -0.001}, scene.projector_lens = {-0.05, 0.02, 0, 0.001};
  return scene;
}

void know_all(synthetic::BoardTruth& truth) {
  for (int d = 0; d < 2; ++d)
    truth.capture.devices[d].known = device_of(truth.rig, truth.model, truth.capture, d);
}

std::vector<double> place_error(const Device& found, const Rigid& truth) {
  const Rigid& place = found.device_from_world;
  const glm::dvec3 w = rotation_vector_rad(place.rotation * glm::transpose(truth.rotation));
  const glm::dvec3 t = place.translation - truth.translation;
  return {w.x, w.y, w.z, t.x, t.y, t.z};
}

TEST(KnownDevices, OnePoseOfAFlatBoardPlacesTheProjector) {
  auto random = generator();
  synthetic::BoardTruth truth = synthetic::board_truth(scene_of(1), random);
  BoardOptions options;
  options.estimate_sigma = false;
  options.tolerance_px = 100;
  EXPECT_EQ(calibrate_boards(truth.capture, options).status, Status::refused);
  EXPECT_THAT(calibrate_boards(truth.capture, options).reason, HasSubstr("known intrinsics of every device"));
  know_all(truth);
  const BoardCalibration c = calibrate_boards(truth.capture, options);
  ASSERT_EQ(c.status, Status::ok) << c.reason;
  const Rigid& place = truth.rig.devices[1].device_from_camera;
  for (const double e : place_error(c.devices[1], place))
    EXPECT_LT(std::abs(e), 1e-7);  // no noise: the solver's end
  EXPECT_EQ(c.devices[1].lens.parameters, truth.capture.devices[1].known->lens.parameters);
}

TEST(KnownDevices, CovarianceOfThePlaceIsThatOfSampling) {
  auto random = generator();
  synthetic::BoardTruth truth = synthetic::board_truth(scene_of(1), random);
  know_all(truth);
  BoardOptions options;
  options.estimate_sigma = false;
  options.tolerance_px = 100;
  double sum = 0;
  constexpr int trials = 60;
  for (int k = 0; k < trials; ++k) {
    const BoardCalibration c = calibrate_boards(synthetic::with_noise(truth.capture, random), options);
    ASSERT_NE(c.status, Status::refused) << c.reason;
    ASSERT_EQ(c.covariance.globals, 6);
    sum += testing::mahalanobis(place_error(c.devices[1], truth.rig.devices[1].device_from_camera),
                                c.covariance.global);
  }
  // χ² with 6 degrees of freedom: mean 6, the mean of 60 has a standard deviation of sqrt(12/60) = 0.447.
  EXPECT_NEAR(sum / trials, 6, 4 * 0.447);
}

TEST(KnownDevices, AKnownCameraMakesTheProjectorSurer) {
  auto random = generator();
  synthetic::BoardTruth truth = synthetic::board_truth(scene_of(6), random);
  BoardOptions options;
  options.terms = {lens_terms("k1k2p1p2"), lens_terms("k1k2p1p2")};
  options.tolerance_px = 100;
  const BoardCapture noisy = synthetic::with_noise(truth.capture, random);
  const BoardCalibration free = calibrate_boards(noisy, options);
  BoardCapture told = noisy;
  told.devices[0].known = device_of(truth.rig, truth.model, truth.capture, 0);
  const BoardCalibration known = calibrate_boards(told, options);
  ASSERT_NE(free.status, Status::refused) << free.reason;
  ASSERT_NE(known.status, Status::refused) << known.reason;
  EXPECT_LT(known.diagnosis.predicted_volume_rms_px, free.diagnosis.predicted_volume_rms_px);
  EXPECT_EQ(known.devices[0].intrinsics.fx, told.devices[0].known->intrinsics.fx);
  EXPECT_NE(known.devices[1].intrinsics.fx, free.devices[1].intrinsics.fx);
}

// Known to sigmas: what is told of the intrinsics is drawn about the truth as often as the pixels are.
TEST(KnownDevices, SigmasMakeAPriorAndTheCovarianceHoldsIt) {
  auto random = generator();
  synthetic::BoardTruth truth = synthetic::board_truth(scene_of(2), random);
  const std::vector<double> sigma = {4, 4, 3, 3, 0.004, 0.01, 0.0005, 0.0005};
  BoardOptions options;
  options.estimate_sigma = false;
  options.tolerance_px = 100;
  options.ladder.bend = LadderOptions::Bend::off;
  std::normal_distribution<double> normal;
  double sum = 0;
  constexpr int trials = 20, parameters = 8 + 8 + 6;
  for (int n = 0; n < trials; ++n) {
    BoardCapture told = synthetic::with_noise(truth.capture, random);
    for (int d = 0; d < 2; ++d) {
      Device known = device_of(truth.rig, truth.model, truth.capture, d);
      Intrinsics& k = known.intrinsics;
      for (double* value : {&k.fx, &k.fy, &k.cx, &k.cy}) *value += sigma[value - &k.fx] * normal(random);
      for (int i = 0; i < 4; ++i) known.lens.parameters[i] += sigma[4 + i] * normal(random);
      told.devices[d].known = known;
      told.devices[d].known_sigma = sigma;
    }
    const BoardCalibration c = calibrate_boards(told, options);
    ASSERT_NE(c.status, Status::refused) << c.reason;
    ASSERT_EQ(c.covariance.globals, parameters);
    const RigFit& fit = c.ladder.fit;
    sum += testing::mahalanobis(global_step(fit.adjustment.rig, truth.rig, columns_of(fit.model)),
                                c.covariance.global);
    for (int i = 0; i < 4; ++i) EXPECT_LT(c.sigma[i], sigma[i]);  // the boards add to what was known
  }
  // χ²: the mean of 20 with 22 degrees of freedom has a standard deviation of sqrt(44/20) = 1.48.
  EXPECT_NEAR(sum / trials, parameters, 4 * 1.48);
}

TEST(KnownDevices, SigmasOfZeroHold) {
  auto random = generator();
  synthetic::BoardTruth truth = synthetic::board_truth(scene_of(3), random);
  know_all(truth);
  for (BoardDevice& device : truth.capture.devices) device.known_sigma.assign(8, 0.0);
  BoardOptions options;
  options.ladder.bend = LadderOptions::Bend::off;
  EXPECT_EQ(calibrate_boards(truth.capture, options).covariance.globals, 6);
  truth.capture.devices[0].known_sigma.pop_back();
  EXPECT_THAT(testing::input_error([&] { calibrate_boards(truth.capture); }),
              HasSubstr("camera: 7 sigmas of the known intrinsics, expected 8"));
}

TEST(KnownDevices, AFarBoardHasTwoPlacementsAndSaysSo) {
  auto random = generator();
  synthetic::BoardTruth truth = synthetic::board_truth(scene_of(1), random);
  know_all(truth);
  // Nine pixels across in the middle of the image: foreshortening is a few hundredths of a pixel, below the
  // noise.
  const RigProblem problem(truth.capture, truth.model);
  Rigid& board = truth.rig.camera_from_board[0];
  board.translation = {0, 0, 100};
  std::erase_if(truth.capture.sightings, [](const Sighting& s) { return s.device == 1; });
  for (Sighting& s : truth.capture.sightings) {
    double pixel[2];
    ASSERT_TRUE(predict(problem, truth.rig, s, pixel, nullptr));
    s.pixel = {pixel[0], pixel[1]};
  }
  truth.capture.devices.pop_back();
  BoardOptions options;
  options.tolerance_px = 1e6;
  const BoardCalibration c = calibrate_boards(synthetic::with_noise(truth.capture, random), options);
  EXPECT_EQ(c.status, Status::weak);
  EXPECT_THAT(c.reason, HasSubstr("another placement"));
}

TEST(KnownDevices, IntrinsicsOfAnotherSizeAreNamed) {
  auto random = generator();
  synthetic::BoardTruth truth = synthetic::board_truth(scene_of(3), random);
  know_all(truth);
  truth.capture.devices[1].known->intrinsics.size = {640, 480};
  EXPECT_THAT(testing::input_error([&] { calibrate_boards(truth.capture); }),
              HasSubstr("projector: the known intrinsics are of 640x480 px, expected 1024x768"));
}

}  // namespace
}  // namespace laterna
