// A projector whose intrinsics are known: its placement alone, from flat scenes too.
#include "calib/solve.h"
#include "sim/error.h"
#include "tests/calib/trials.h"
#include "tests/testing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace laterna {
namespace {

using testing::add_noise;
using testing::add_outliers;
using testing::generator;
using testing::near_plane;
using testing::scattered;
using testing::tangent_error;
using testing::usual_projector;

KnownIntrinsics known_of(const Device& d) { return {d.intrinsics, d.lens}; }

SolveOptions known_options(const Device& d) {
  SolveOptions options;
  options.known = known_of(d);
  return options;
}

// The largest tangent error of the placement, rotation in rad and translation in m.
double placement_error(const Device& truth, const Device& estimate) {
  const std::vector<double> e = tangent_error(truth, estimate);
  double largest = 0;
  for (std::size_t i = e.size() - 6; i < e.size(); ++i) largest = std::max(largest, std::abs(e[i]));
  return largest;
}

// eᵀ·C⁻¹·e over the last six parameters.
double placement_chi2(const Device& truth, const SolveResult& r, const std::vector<double>& covariance) {
  std::vector<double> e = tangent_error(truth, r.estimate), c;
  const std::size_t p = e.size();
  for (std::size_t i = p - 6; i < p; ++i)
    for (std::size_t j = p - 6; j < p; ++j) c.push_back(covariance[i * p + j]);
  return testing::mahalanobis({e.end() - 6, e.end()}, c);
}

TEST(Placement, ComesBackFromAPlaneWithoutNoise) {
  const Device truth = usual_projector();
  auto random = generator();
  const Correspondences c = near_plane(truth, 60, 2, 0, 0.1, random);
  EXPECT_EQ(solve(c, truth.intrinsics.size).status, Status::refused);  // with free intrinsics it is a plane
  const SolveResult r = solve(c, truth.intrinsics.size, known_options(truth));
  EXPECT_EQ(r.status, Status::ok) << r.reason;
  EXPECT_EQ(r.free_parameters, 6);
  EXPECT_LT(placement_error(truth, r.estimate),
            1e-8);  // the prior holds the intrinsics to 1e-6 px, 1e-9 of f
  EXPECT_NEAR(r.estimate.intrinsics.fx, truth.intrinsics.fx, 1e-6);
}

TEST(Placement, ComesBackWithALensFromAVolume) {
  Device truth = usual_projector();
  truth.lens = {"LENSMODEL_OPENCV5", {-0.1, 0.03, 0.001, -0.002, 0.01}};
  auto random = generator();
  const Correspondences c = scattered(truth, 40, 1.5, 2.5, 0.1, random);
  const SolveResult r = solve(c, truth.intrinsics.size, known_options(truth));
  EXPECT_EQ(r.status, Status::ok) << r.reason;
  EXPECT_EQ(r.estimate.lens.model, truth.lens.model);
  EXPECT_LT(placement_error(truth, r.estimate), 1e-8);  // as above
}

TEST(Placement, FourPointsOfAPlaneAreEnoughAndThreeAreNot) {
  const Device truth = usual_projector();
  Correspondences c;
  for (const glm::dvec2 pixel :
       {glm::dvec2(100, 90), glm::dvec2(1200, 80), glm::dvec2(1150, 700), glm::dvec2(60, 720)})
    testing::add_point(c, truth, pixel, 2, 0.1);
  EXPECT_LT(placement_error(truth, solve(c, truth.intrinsics.size, known_options(truth)).estimate), 1e-7);
  c.world_points.pop_back(), c.projector_pixels.pop_back(), c.sigma_px.pop_back();
  const SolveResult r = solve(c, truth.intrinsics.size, known_options(truth));
  EXPECT_EQ(r.status, Status::refused);
  EXPECT_THAT(r.reason, ::testing::HasSubstr("3 correspondences"));
}

TEST(Placement, CovarianceOfAPlaneIsThatOfSampling) {
  const Device truth = usual_projector();
  auto random = generator();
  const Correspondences clean = near_plane(truth, 80, 2, 0, 0.2, random);
  double sum = 0;
  constexpr int trials = 200;
  for (int k = 0; k < trials; ++k) {
    Correspondences noisy = clean;
    add_noise(noisy, random);
    const SolveResult r = solve(noisy, truth.intrinsics.size, known_options(truth));
    ASSERT_EQ(r.status, Status::ok) << r.reason;
    sum += placement_chi2(truth, r, r.covariance_independent);
  }
  // χ² with 6 degrees of freedom: mean 6, the mean of 200 has a standard deviation of sqrt(12/200) = 0.245.
  EXPECT_NEAR(sum / trials, 6, 4 * 0.245);
}

// Known to 4 px of the focal lengths and 6 px of the centre, and off by as much.
SolveOptions wrongly_told(const Device& truth, std::mt19937_64& random) {
  SolveOptions options = known_options(truth);
  options.tolerance_px = 100;
  options.known->sigma = {4, 4, 6, 6};
  Intrinsics& told = options.known->intrinsics;
  std::normal_distribution<double> normal;
  told.fx += 4 * normal(random), told.fy += 4 * normal(random);
  told.cx += 6 * normal(random), told.cy += 6 * normal(random);
  return options;
}

TEST(Placement, UncertainIntrinsicsAreCarriedIntoTheCovariance) {
  const Device truth = usual_projector();
  auto random = generator();
  const Correspondences clean = near_plane(truth, 80, 2, 0, 0.2, random);
  double sum = 0, exact = 0;
  constexpr int trials = 200;
  for (int k = 0; k < trials; ++k) {
    Correspondences noisy = clean;
    add_noise(noisy, random);
    SolveOptions options = wrongly_told(truth, random);
    const SolveResult r = solve(noisy, truth.intrinsics.size, options);
    ASSERT_NE(r.status, Status::refused) << r.reason;
    sum += placement_chi2(truth, r, r.covariance_independent);
    options.known->sigma.clear();
    const SolveResult believed = solve(noisy, truth.intrinsics.size, options);
    exact += placement_chi2(truth, believed, believed.covariance_independent);
  }
  EXPECT_NEAR(sum / trials, 6, 4 * 0.245);  // as above
  EXPECT_GT(exact / trials, 100);           // believing them exact would promise ten times too much
}

// The jackknife over blocks sees what the points do, and not that the intrinsics were told wrong: those have
// to be added, or the placement would look ten times as sure as it is.
TEST(Placement, UncertainIntrinsicsCountBesideBlocksToo) {
  const Device truth = usual_projector();
  auto random = generator();
  Correspondences clean = near_plane(truth, 600, 2, 0, 0.2, random);
  for (const glm::dvec2& p : clean.projector_pixels)
    clean.cluster.push_back(std::uint32_t(p.x / 80) + 1000 * std::uint32_t(p.y / 80));
  double sum = 0;
  constexpr int trials = 100;
  for (int k = 0; k < trials; ++k) {
    Correspondences noisy = clean;
    add_noise(noisy, random);
    SolveOptions options = wrongly_told(truth, random);
    const SolveResult r = solve(noisy, truth.intrinsics.size, options);
    ASSERT_NE(r.status, Status::refused) << r.reason;
    ASSERT_TRUE(r.clusters_suffice);
    sum += placement_chi2(truth, r, r.covariance);
  }
  // χ² with 6 degrees of freedom: the mean of 100 has a standard deviation of 0.35, and the jackknife over
  // some 160 blocks is rough by a few percent.
  EXPECT_NEAR(sum / trials, 6, 4 * 0.35 + 0.3);
}

TEST(Placement, APlaneThatIsFarAndSmallHasTwoPlacementsAndSaysSo) {
  // Rays within 0.1° of one another: over the plane the depth changes by 0.05 %, 0.3 px at the image's edge,
  // so that a tilt and its mirror image look alike in pixels of 0.5 px.
  const Device truth = testing::projector({1280, 800}, 600000, {639.5, 399.5}, {glm::dmat3(1.0), {0, 0, 0}});
  auto random = generator();
  Correspondences c = near_plane(truth, 60, 20, 0, 0.5, random);
  add_noise(c, random);
  const SolveResult r = solve(c, truth.intrinsics.size, known_options(truth));
  EXPECT_EQ(r.status, Status::weak);
  EXPECT_THAT(r.reason, ::testing::HasSubstr("another placement"));
}

TEST(Placement, WrongIntrinsicsShowInTheResiduals) {
  const Device truth = usual_projector();
  auto random = generator();
  Correspondences c = scattered(truth, 200, 1, 3, 0.1, random);
  add_noise(c, random);
  SolveOptions options = known_options(truth);
  options.known->intrinsics.fx *= 1.05, options.known->intrinsics.fy *= 1.05;
  const SolveResult r = solve(c, truth.intrinsics.size, options);
  EXPECT_EQ(r.status, Status::weak);
  EXPECT_THAT(r.reason, ::testing::HasSubstr("times what the sigmas explain"));
}

TEST(Placement, OutliersAreBorneWithARobustLoss) {
  const Device truth = usual_projector();
  auto random = generator();
  Correspondences c = near_plane(truth, 300, 2, 0, 0.1, random);
  add_noise(c, random);
  add_outliers(c, truth.intrinsics.size, 0.3, random);
  SolveOptions options = known_options(truth);
  options.loss.kind = RobustLoss::Kind::cauchy;
  const SolveResult r = solve(c, truth.intrinsics.size, options);
  EXPECT_EQ(r.status, Status::ok) << r.reason;
  EXPECT_LT(placement_error(truth, r.estimate),
            1e-3);  // ten times the sigma of the clean points' translation
}

TEST(Placement, MalformedKnownIntrinsicsAreNamed) {
  const Device truth = usual_projector();
  auto random = generator();
  const Correspondences c = scattered(truth, 20, 1, 3, 0.1, random);
  const auto message = [&](const KnownIntrinsics& known) {
    SolveOptions options;
    options.known = known;
    return testing::input_error([&] { solve(c, truth.intrinsics.size, options); });
  };
  KnownIntrinsics known = known_of(truth);
  known.intrinsics.size = {640, 480};
  EXPECT_THAT(message(known), ::testing::HasSubstr("640 × 480 px, expected the projector's 1280 × 800"));
  known = known_of(truth);
  known.sigma = {1, 1};
  EXPECT_THAT(message(known), ::testing::HasSubstr("2 sigmas, expected 0 and 4"));
  known.sigma = {1, 1, 1, -1};
  EXPECT_THAT(message(known), ::testing::HasSubstr("is -1, expected a number from 0"));
}

}  // namespace
}  // namespace laterna
