// Splined lenses in the joint adjustment of boards.
#include "calib/boards/rig_splines.h"

#include "calib/boards/calibrate_boards.h"
#include "calib/boards/synthetic_boards.h"
#include "calib/peers/board_methods.h"
#include "calib/splined_lens.h"
#include "sim/spline_knots.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using testing::generator;
using ::testing::HasSubstr;

// A camera whose lens is off that of four terms by 2 px, as a spline of 3 × 3 cells, and a pinhole projector.
synthetic::BoardTruth splined_truth(int poses, std::mt19937_64& random) {
  Device camera;
  camera.intrinsics = {{1280, 1024}, 1810, 1805, 655, 500};
  camera.lens = {"LENSMODEL_OPENCV4", {-0.12, 0.05, 0.001, -0.001}};
  const std::string model = spline_over_image(camera, 3);
  const std::vector<double> k = spline_like(camera, model);
  synthetic::BoardScene scene;
  scene.poses = poses;
  scene.camera_terms = {model};
  scene.camera_lens = {k.begin() + 4, k.end()};
  std::normal_distribution<double> normal;
  for (double& knot : scene.camera_lens) knot += 2.0 / 1810 * normal(random);
  return synthetic::board_truth(scene, random);
}

BoardOptions lenses(const std::string& camera) {
  BoardOptions options;
  options.terms = {lens_terms(camera), lens_terms("pinhole")};
  options.tolerance_px = 100;
  return options;
}

TEST(RigSplines, WordsNameAModelOrLeaveTheGridToTheImage) {
  EXPECT_TRUE(are_splined(lens_terms("splined")));
  const std::string model = "LENSMODEL_SPLINED_STEREOGRAPHIC_order=3_Nx=8_Ny=7_fov_x_deg=50";
  EXPECT_EQ(lens_terms(model), std::vector<std::string>{model});
  EXPECT_EQ(model_of_terms({model}).lens_free.size(), 112u);
  EXPECT_EQ(terms_text({model}), "splined 8x7");
  EXPECT_FALSE(are_splined(lens_terms("k1")));
  EXPECT_THAT(testing::input_error([] { lens_terms("LENSMODEL_SPLINED_STEREOGRAPHIC_order=9_Nx=8"); }),
              HasSubstr("order"));
}

// Six boards over the image; what is compared is the camera's direction of each pixel that was seen.
TEST(RigSplines, ASplineFitsWhereFourTermsDoNot) {
  auto random = generator();
  const synthetic::BoardTruth truth = splined_truth(6, random);
  const BoardCapture noisy = synthetic::with_noise(truth.capture, random);
  const BoardCalibration lean = calibrate_boards(noisy, lenses("opencv4"));
  const BoardCalibration rich = calibrate_boards(noisy, lenses("splined"));
  ASSERT_NE(lean.status, Status::refused) << lean.reason;
  ASSERT_NE(rich.status, Status::refused) << rich.reason;
  EXPECT_TRUE(is_splined(rich.devices[0].lens.model)) << rich.devices[0].lens.model;
  EXPECT_GT(lean.ladder.fit.sigma_px[0], 0.2);          // the noise is 0.1 px, the lens left out some 0.25
  EXPECT_NEAR(rich.ladder.fit.sigma_px[0], 0.1, 0.03);  // some 600 residuals, and cells of another grid
  EXPECT_LT(rich.held_out().rms_px, lean.held_out().rms_px);
}

TEST(RigSplines, TheTrueGridIsRecoveredWithinItsSigmas) {
  auto random = generator();
  const synthetic::BoardTruth truth = splined_truth(7, random);
  const BoardCalibration c = calibrate_boards(synthetic::with_noise(truth.capture, random),
                                              lenses(truth.model.devices[0].lens_model));
  ASSERT_NE(c.status, Status::refused) << c.reason;
  EXPECT_THAT(c.parameter_names, ::testing::Contains("camera knot10_x"));
  EXPECT_THAT(c.parameter_names, ::testing::Not(::testing::Contains("camera fx")));  // the core is held
  EXPECT_NEAR(c.ladder.fit.sigma_px[0], 0.1, 0.012);  // 1/sqrt(2·600) of it is 3 %: four times that
  EXPECT_NEAR(c.fit_rms_px(), 0.2 * std::sqrt(2.0), 0.03);
}

TEST(RigSplines, MrcalsOwnOptimisationAgrees) {
  auto random = generator();
  const synthetic::BoardTruth truth = splined_truth(4, random);
  BoardOptions options = lenses(truth.model.devices[0].lens_model);
  options.terms[1] = options.terms[0];
  const BoardCalibration c = calibrate_boards(synthetic::with_noise(truth.capture, random), options);
  ASSERT_NE(c.status, Status::refused) << c.reason;
  const RigFit& fit = c.ladder.fit;
  for (const MethodResult& m : compare_board_methods(fit.capture, fit.model)) {
    if (m.name.starts_with("opencv")) {
      EXPECT_THAT(m.failure, HasSubstr("splined"));
    } else {
      ASSERT_TRUE(m.rig) << m.name << ": " << m.failure;
      EXPECT_NEAR(m.fit_rms_px[0], fit.rms_px[0], 0.02) << m.name;
    }
  }
}

}  // namespace
}  // namespace laterna
