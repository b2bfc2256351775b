#include "calib/boards/calibrate_boards.h"

#include "calib/boards/correspondence_csv.h"
#include "tests/calib/boards/synthetic_boards.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>

namespace laterna {
namespace {

using ::testing::HasSubstr;

BoardOptions given(const std::string& word) {
  BoardOptions options;
  options.terms = {lens_terms(word), lens_terms(word)};
  return options;
}

BoardCapture noisy(const testing::BoardScene& scene, std::mt19937_64& random) {
  return testing::with_noise(testing::board_truth(scene, random).capture, random);
}

TEST(CalibrateBoards, FindsALensShiftedProjectorWithoutAGuess) {
  auto random = testing::generator();
  const auto t = testing::board_truth({}, random);
  const BoardCalibration c = calibrate_boards(testing::with_noise(t.capture, random), given("pinhole"));
  ASSERT_EQ(c.status, Status::ok) << c.reason;
  EXPECT_TRUE(c.ladder.fit.adjustment.converged);
  for (std::size_t i = 0; i < c.sigma.size(); ++i) {  // each within five of its own sigmas
    const auto e = global_step(c.ladder.fit.adjustment.rig, t.rig, columns_of(t.model));
    EXPECT_LT(std::abs(e[i]), 5 * c.sigma[i]) << c.parameter_names[i];
  }
  EXPECT_NEAR(c.devices[1].intrinsics.cy, 860, 30);  // below the image of 768 rows
  EXPECT_NEAR(c.ladder.fit.sigma_px[0], 0.1, 0.02);  // estimated; some 700 residuals
  EXPECT_EQ(c.diagnosis.poses.size(), 6u);
}

TEST(CalibrateBoards, OnePoseIsRefused) {
  auto random = testing::generator();
  testing::BoardScene scene;
  scene.poses = 1;
  const BoardCalibration c = calibrate_boards(noisy(scene, random));
  EXPECT_EQ(c.status, Status::refused);
  EXPECT_THAT(c.reason, HasSubstr("one pose of a flat board"));
}

TEST(CalibrateBoards, TwoPosesAndParallelBoardsAreNeverOk) {
  auto random = testing::generator();
  testing::BoardScene two;
  two.poses = 2;
  EXPECT_NE(calibrate_boards(noisy(two, random)).status, Status::ok);
  testing::BoardScene parallel;
  parallel.least_tilt = 0, parallel.most_tilt = 0.03;
  const BoardCalibration c = calibrate_boards(noisy(parallel, random), given("pinhole"));
  EXPECT_NE(c.status, Status::ok);
  EXPECT_THAT(c.reason, HasSubstr("tilted"));  // the cure
}

TEST(CalibrateBoards, AMirroredProjectorIsRefused) {
  auto random = testing::generator();
  BoardCapture capture = noisy({}, random);
  for (Sighting& s : capture.sightings)
    if (s.device == 1) s.pixel.x = 1023 - s.pixel.x;
  const BoardCalibration c = calibrate_boards(capture, given("pinhole"));
  EXPECT_EQ(c.status, Status::refused) << c.reason;
  EXPECT_THAT(c.reason, HasSubstr("projector"));
}

TEST(CalibrateBoards, GrossOutliersAreDroppedAndNamed) {
  auto random = testing::generator();
  const auto t = testing::board_truth({}, random);
  BoardCapture capture = testing::with_noise(t.capture, random);
  for (const std::size_t i : {5u, 200u, 400u}) capture.sightings[i].pixel += glm::dvec2(25, -10);
  const BoardCalibration c = calibrate_boards(capture, given("pinhole"));
  ASSERT_EQ(c.status, Status::ok) << c.reason;
  ASSERT_EQ(c.dropped.size(), 3u);
  for (const double residual : c.dropped_residual_px) EXPECT_NEAR(residual, std::hypot(25, 10), 3);
  EXPECT_EQ(c.dropped_poses[0], capture.sightings[5].pose);
  EXPECT_LT(c.fit_rms_px(), 0.35);  // noise is 0.28
}

TEST(CalibrateBoards, PosesWithTooFewCornersAreNotUsed) {
  auto random = testing::generator();
  BoardCapture capture = noisy({}, random);
  std::erase_if(capture.sightings,
                [](const Sighting& s) { return s.pose == 2 && s.device == 0 && s.corner > 2; });
  const BoardCalibration c = calibrate_boards(capture, given("pinhole"));
  EXPECT_EQ(c.unused_poses, std::vector<int>{2});
  EXPECT_EQ(c.diagnosis.poses.size(), 5u);
}

TEST(CalibrateBoards, WrongSigmasAreNoticed) {
  auto random = testing::generator();
  BoardCapture capture = noisy({}, random);
  for (Sighting& s : capture.sightings) s.sigma_px /= 4;
  BoardOptions options = given("pinhole");
  options.estimate_sigma = false;
  const BoardCalibration c = calibrate_boards(capture, options);
  EXPECT_EQ(c.status, Status::weak);
  EXPECT_THAT(c.reason, HasSubstr("times what the sigmas explain"));
}

// The real capture of the public sample data, five poses; the README beside it has the numbers.
std::optional<BoardCapture> real_capture() {
  const char* captures = std::getenv("LATERNA_CAPTURES");
  if (!captures) return {};
  const auto file = std::filesystem::path(captures) / "graycode-procam-kamino/correspondences.csv";
  if (!std::filesystem::exists(file)) return {};
  return read_correspondence_csv(file, {1280, 1024}, {1024, 768});
}

#define REAL_CAPTURE_OR_SKIP(capture)  \
  const auto capture = real_capture(); \
  if (!(capture))                      \
  GTEST_SKIP() << "LATERNA_CAPTURES does not name a folder with graycode-procam-kamino/correspondences.csv"

TEST(CalibrateBoards, TheRealCaptureForecastsAsItShould) {
  REAL_CAPTURE_OR_SKIP(capture);
  const BoardCalibration c = calibrate_boards(*capture);
  ASSERT_EQ(c.status, Status::ok) << c.reason;
  EXPECT_LT(c.held_out().rms_px, 0.29);  // what is aimed for; 0.34 is asked
  EXPECT_EQ(c.held_out().folds.size(), 5u);
  const Intrinsics& k = c.devices[1].intrinsics;
  for (const double f : {k.fx, k.fy}) {
    EXPECT_GT(f, 1880);
    EXPECT_LT(f, 1910);
  }
  EXPECT_GT(k.cy, 825);
  EXPECT_LT(k.cy, 880);
  EXPECT_GT(c.ladder.rungs[0].held_out.rms_px, 0.6);  // pinhole is not enough, by the same rule
}

// Every sighting, flat board: two other programs' joint adjustments gave 0.33 with k1 and 0.28 with k1k2p1p2
// on both devices, and 0.29 to 0.30 with k1k2p1p2 and k1; eight parameters forecast worse than one.
TEST(CalibrateBoards, TheRealCaptureGivesTheKnownNumbers) {
  REAL_CAPTURE_OR_SKIP(capture);
  const auto held_out_px = [&](const std::string& camera, const std::string& projector) {
    BoardOptions options;
    options.terms = {lens_terms(camera), lens_terms(projector)};
    options.drop_beyond_sigmas = 0;
    const BoardCalibration c = calibrate_boards(*capture, options);
    return c.status != Status::refused && c.held_out().failed.empty() ? c.held_out().rms_px : INFINITY;
  };
  EXPECT_NEAR(held_out_px("k1", "k1"), 0.33, 0.005);  // to the two digits given
  EXPECT_NEAR(held_out_px("k1k2p1p2", "k1k2p1p2"), 0.28, 0.005);
  EXPECT_NEAR(held_out_px("k1k2p1p2", "k1"), 0.295, 0.01);
  EXPECT_GT(held_out_px("pinhole", "pinhole"), 0.7);
  EXPECT_GT(held_out_px("opencv8", "opencv8"), 0.34);  // or no solution in some fold
}

// Rational terms trade off against one another over five poses: an answer, and what it cannot tell.
TEST(CalibrateBoards, ManyTermsOnTheRealCaptureAreWeak) {
  REAL_CAPTURE_OR_SKIP(capture);
  BoardOptions options;
  options.terms = {lens_terms("opencv8"), lens_terms("opencv8")};
  const BoardCalibration c = calibrate_boards(*capture, options);
  EXPECT_EQ(c.status, Status::weak);
  EXPECT_THAT(c.reason, ::testing::HasSubstr("trade off"));
  EXPECT_LT(c.fit_rms_px(), 0.161);  // no worse than with k3, which it contains: 0.1603
}

TEST(CalibrateBoards, FewRealPosesAreNeverOk) {
  REAL_CAPTURE_OR_SKIP(capture);
  for (int a = 0; a < 5; ++a) {
    EXPECT_EQ(calibrate_boards(with_poses(*capture, {a})).status, Status::refused);
    for (int b = 0; b < a; ++b) EXPECT_NE(calibrate_boards(with_poses(*capture, {a, b})).status, Status::ok);
  }
}

}  // namespace
}  // namespace laterna
