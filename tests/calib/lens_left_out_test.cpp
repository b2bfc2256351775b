#include "calib/lens_left_out.h"

#include "calib/refine.h"
#include "calib/solve.h"
#include "tests/calib/synthetic.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using testing::add_noise;
using testing::generator;
using testing::scattered;

Device with_k1(double k1) {
  Device d = testing::usual_projector();
  d.lens = {"LENSMODEL_OPENCV4", {k1, 0, 0, 0}};
  return d;
}

std::optional<LensLeftOut> left_out(const Correspondences& c, const Device& truth) {
  const WorldNormalisation n = normalisation_of(c.world_points);
  const PointTable points = point_table(c, n);
  Device pinhole = truth;
  pinhole.lens = {};
  ProjectorState start = state_of(pinhole);
  start.device_from_points = device_from_normalised(pinhole.device_from_world, n);
  const auto fit = refine(points, LensGradient("LENSMODEL_PINHOLE"), start, {});
  return fit ? lens_left_out(points, fit->state, {}, n, truth.intrinsics.size) : std::nullopt;
}

// Without noise one step finds what was left out: the model is linear in it but for the pinhole's shift,
// second order in k1.
TEST(LensLeftOut, FindsTheTermThatIsThere) {
  auto random = generator();
  const Device truth = with_k1(-0.02);
  const Correspondences c = scattered(truth, 800, 1.5, 2.5, 0.1, random);
  const auto left = left_out(c, truth);
  ASSERT_TRUE(left);
  EXPECT_NEAR(left->device.lens.parameters[0], -0.02, 0.002);
  EXPECT_GT(left->wald, 100);  // chance is below 28.5
}

// Where there is no lens the statistic is χ² of four degrees of freedom: mean 4, and the mean of 60 has the
// standard deviation sqrt(8/60) = 0.37; four of them.
TEST(LensLeftOut, NoiseAloneIsChiSquared) {
  auto random = generator();
  const Device truth = with_k1(0);
  double sum = 0;
  constexpr int trials = 60;
  for (int k = 0; k < trials; ++k) {
    Correspondences c = scattered(truth, 400, 1.5, 2.5, 0.2, random);
    add_noise(c, random);
    const auto left = left_out(c, truth);
    ASSERT_TRUE(left);
    sum += left->wald;
  }
  EXPECT_NEAR(sum / trials, 4, 1.5);
}

// A pinhole on what a lens of k1 = -0.03 shows, at noise that hides it in the rms: weak, with the reason.
TEST(LensLeftOut, APinholeOverALensIsWeak) {
  auto random = generator();
  Correspondences c = scattered(with_k1(-0.03), 600, 1.5, 2.5, 0.3, random);
  add_noise(c, random);
  const SolveResult r = solve(c, {1280, 800});
  EXPECT_EQ(r.status, Status::weak);
  EXPECT_THAT(r.reason, ::testing::HasSubstr("k1 = -0.0"));
  SolveOptions lens;
  lens.lens_model = "LENSMODEL_OPENCV4";
  EXPECT_EQ(solve(c, {1280, 800}, lens).status, Status::ok);
}

TEST(LensLeftOut, NoneWhereTheLargerModelIsNotDetermined) {
  auto random = generator();
  const Device truth = with_k1(0);
  EXPECT_FALSE(left_out(scattered(truth, 6, 1.5, 2.5, 0.1, random), truth));  // 12 numbers for 14 unknowns
}

}  // namespace
}  // namespace laterna
