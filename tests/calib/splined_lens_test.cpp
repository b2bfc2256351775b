// Splined lenses of a projector that is seen with known geometry.
#include "calib/splined_lens.h"

#include "calib/solve.h"
#include "sim/lens.h"
#include "sim/spline_knots.h"
#include "tests/calib/synthetic.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <span>

namespace laterna {
namespace {

using testing::generator;
using ::testing::HasSubstr;

Device with_radial(const std::vector<double>& lens) {
  Device d = testing::usual_projector();
  d.lens = {"LENSMODEL_OPENCV4", lens};
  return d;
}

// A lens that no polynomial of four terms is: knots 3 px off those of one, at random.
Device with_spline(std::mt19937_64& random) {
  Device d = with_radial({-0.08, 0.03, 0.001, -0.001});
  const std::string model = spline_over_image(d, 4);
  std::vector<double> k = spline_like(d, model);
  std::normal_distribution<double> normal;
  d.lens = {model, {k.begin() + 4, k.end()}};
  for (double& knot : d.lens.parameters) knot += 3 / d.intrinsics.fx * normal(random);
  return d;
}

// rms of an estimate's pixels of points over the truth's.
double error_px(const Device& truth, const Device& estimate, std::span<const glm::dvec3> points) {
  double sum = 0;
  for (const glm::dvec2& e : error_vectors(truth, estimate, points)) sum += glm::dot(e, e);
  return std::sqrt(sum / double(points.size()));
}

TEST(SplinedLens, TheGridCoversTheImageAndStartsLikeTheLens) {
  const Device lean = with_radial({-0.08, 0.03, 0.001, -0.001});
  const std::string model = spline_over_image(lean);
  ASSERT_TRUE(is_splined(model)) << model;
  const std::vector<double> k = spline_like(lean, model);
  ASSERT_EQ(int(k.size()), 4 + lens_parameter_count(model));
  Device splined = lean;
  splined.lens = {model, {k.begin() + 4, k.end()}};
  const LensProjection a(lean.intrinsics, lean.lens), b(lean.intrinsics, splined.lens);
  for (int row = 0; row <= 10; ++row) {
    for (int column = 0; column <= 10; ++column) {
      const double u = 127.9 * column, v = 79.9 * row;  // to the last pixel of 1280×800
      const auto ray = a.unproject({u, v});
      ASSERT_TRUE(ray);
      const auto pixel = b.project(*ray);
      ASSERT_TRUE(pixel);
      EXPECT_LT(glm::length(*pixel - glm::dvec2(u, v)), 5e-3 * 1920);  // a start, as the header says
    }
  }
}

TEST(SplinedLens, APinholeIsRecoveredFromExactPoints) {
  auto random = generator();
  const Device truth = testing::usual_projector();
  const Correspondences points = testing::scattered(truth, 3000, 1, 4, 0.05, random);
  SolveOptions options;
  options.lens_model = spline_over_image(truth, 4);
  const SolveResult r = solve(points, truth.intrinsics.size, options);
  ASSERT_NE(r.status, Status::refused) << r.reason;
  // A cubic over cells of a tenth: u(θ) departs from a cubic by some 1e-5 of f.
  EXPECT_LT(error_px(truth, r.estimate, points.world_points), 0.02);
}

TEST(SplinedLens, ASplineIsRecoveredFromExactPointsAndAPolynomialSaysItIsNot) {
  auto random = generator();
  const Device truth = with_spline(random);
  const Correspondences points = testing::scattered(truth, 3000, 1, 4, 0.01, random);
  SolveOptions options;
  options.lens_model = truth.lens.model;
  const SolveResult r = solve(points, truth.intrinsics.size, options);
  ASSERT_NE(r.status, Status::refused) << r.reason;
  EXPECT_LT(error_px(truth, r.estimate, points.world_points), 1e-4);  // what the prior pulls at 0.01 px
  options.lens_model = "LENSMODEL_OPENCV4";
  const SolveResult lean = solve(points, truth.intrinsics.size, options);
  EXPECT_EQ(lean.status, Status::weak);
  EXPECT_GT(error_px(truth, lean.estimate, points.world_points), 0.3);
}

TEST(SplinedLens, PredictedErrorIsThatOfSampling) {
  auto random = generator();
  const Device truth = with_spline(random);
  const Correspondences clean = testing::scattered(truth, 1500, 1, 4, 0.2, random);
  SolveOptions options;
  options.lens_model = truth.lens.model;
  double squared = 0, predicted = 0;
  constexpr int trials = 8;
  for (int i = 0; i < trials; ++i) {
    Correspondences noisy = clean;
    testing::add_noise(noisy, random);
    const SolveResult r = solve(noisy, truth.intrinsics.size, options);
    ASSERT_NE(r.status, Status::refused) << r.reason;
    squared += std::pow(error_px(truth, r.estimate, clean.world_points), 2) / trials;
    predicted += std::pow(*predicted_rms(r.estimate, r.covariance, clean.world_points), 2) / trials;
  }
  // Some 100 parameters in each of 8 trials: the ratio of rms scatters by 1/sqrt(2·800) = 2.5 %.
  EXPECT_NEAR(std::sqrt(squared / predicted), 1, 0.1);
}

TEST(SplinedLens, WhereNoPointReachesItIsWeak) {
  auto random = generator();
  const Device truth = with_spline(random);
  Correspondences half = testing::scattered(truth, 4000, 1, 4, 0.1, random);
  Correspondences points;
  for (std::size_t i = 0; i < half.world_points.size(); ++i) {
    if (half.projector_pixels[i].x > 500) continue;
    points.world_points.push_back(half.world_points[i]);
    points.projector_pixels.push_back(half.projector_pixels[i]);
    points.sigma_px.push_back(0.1);
  }
  testing::add_noise(points, random);
  for (const glm::dvec2& p : points.projector_pixels)  // 640 blocks: enough for a jackknife
    points.cluster.push_back(std::uint32_t(p.x / 25) + 1000 * std::uint32_t(p.y / 25));
  SolveOptions options;
  options.lens_model = truth.lens.model;
  const SolveResult r = solve(points, truth.intrinsics.size, options);
  EXPECT_TRUE(r.clusters_suffice);
  EXPECT_EQ(r.status, Status::weak);
  EXPECT_THAT(r.reason, HasSubstr("predicted volume error"));
  EXPECT_GT(r.predicted_volume_rms_px, 1);
}

}  // namespace
}  // namespace laterna
