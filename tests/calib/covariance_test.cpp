#include "calib/covariance.h"

#include "calib/refine.h"
#include "calib/solve.h"
#include "tests/calib/trials.h"
#include "tests/testing.h"

#include <gtest/gtest.h>

#include <map>

namespace laterna {
namespace {

using testing::mean;
using testing::root_mean_square;

// Ids of 80-pixel blocks of the picture.
void add_blocks(Correspondences& c) {
  for (const auto& p : c.projector_pixels)
    c.cluster.push_back(std::uint32_t(p.x / 80) + 1000 * std::uint32_t(p.y / 80));
}

TEST(Covariance, NamesAndWords) {
  const auto names = parameter_names(2);
  EXPECT_EQ(names,
            (std::vector<std::string>{"fx", "fy", "cx", "cy", "lens0", "lens1", "rotation_x", "rotation_y",
                                      "rotation_z", "translation_x", "translation_y", "translation_z"}));
  EXPECT_EQ(direction_in_words({0.6, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.1, -0.8}, names),
            "translation_z and fx trade off");
  EXPECT_EQ(direction_in_words({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, names), "fx is hardly determined");
}

TEST(Covariance, ScaledSpectrumByHand) {
  // Columns (3, 0) and (4, 0.003): nearly parallel once scaled.
  const auto s = scaled_spectrum({3, 4, 0, 0, 0.003, 0, 0, 0, 0}, 2);
  EXPECT_NEAR(s.singular_values[0], std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(s.singular_values[1], 0.00075 / std::sqrt(2.0), 1e-8);  // sine of the angle / √2
  EXPECT_NEAR(s.weakest[0] * s.weakest[1], -0.5, 1e-6);
}

// δt = scale·δt_n + (R·center)×w, checked by moving a pose.
TEST(Covariance, WorldFrameByNumericDifferences) {
  const Device d = testing::usual_projector();
  const WorldNormalisation n{{5, -3, 2}, 0.7};
  const Rigid normalised = device_from_normalised(d.device_from_world, n);
  std::vector<double> step = {1, 2, 3, 4, 1e-7, -2e-7, 3e-7, 2e-7, 1e-7, -1e-7};
  std::vector<double> covariance;
  for (const double a : step)
    for (const double b : step) covariance.push_back(a * b);
  const Rigid turn = rigid_from_rotation_vector({step[4], step[5], step[6]}, glm::dvec3(0.0));
  const Rigid moved{turn.rotation * normalised.rotation,
                    normalised.translation + glm::dvec3(step[7], step[8], step[9])};
  Device after = d;
  after.device_from_world = device_from_world(moved, n);
  const auto e = testing::tangent_error(d, after);
  const auto c = world_covariance(covariance, d.device_from_world, n);
  for (int i = 4; i < 10; ++i)
    for (int j = 4; j < 10; ++j) EXPECT_NEAR(c[i * 10 + j], e[i] * e[j], 1e-5 * 1e-12);  // second order
}

// Closed form for one parameter block that is a mean: leave-one-out of n residuals has variance Σr²/(n(n-1)).
TEST(Covariance, CeresAgreesWithTheFactor) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  const auto c = testing::scattered(truth, 400, 2, 4, 0.2, random);
  const auto n = normalisation_of(c.world_points);
  const auto points = point_table(c, n);
  const LensGradient lens("LENSMODEL_PINHOLE");
  ProjectorState state = state_of(truth);
  state.device_from_points = device_from_normalised(truth.device_from_world, n);
  const auto covariance = ceres_covariance(points, lens, state, {});
  ASSERT_TRUE(covariance);
  const auto r = *row_factor(points, lens, state, {});
  for (int i = 0; i < 10; ++i) {  // C·RᵀR = I
    for (int j = 0; j < 10; ++j) {
      double sum = 0, size = 0;
      for (int k = 0; k < 10; ++k)
        for (int l = 0; l <= std::min(j, k); ++l) {
          const double term = (*covariance)[i * 10 + k] * r[l * 11 + k] * r[l * 11 + j];
          sum += term, size += std::abs(term);
        }
      EXPECT_NEAR(sum, i == j, 1e-9 * std::max(1.0, size)) << i << " " << j;
    }
  }
}

TEST(Covariance, JackknifeIsLeavingOutAndSolvingAgain) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  auto c = testing::scattered(truth, 1000, 2, 4, 0.01, random);
  testing::add_noise(c, random);
  add_blocks(c);
  const auto full = solve(c, truth.intrinsics.size);
  std::map<std::uint32_t, std::vector<std::size_t>> others;
  for (const std::uint32_t g : c.cluster) others[g];
  for (auto& [g, indices] : others)
    for (std::size_t i = 0; i < c.cluster.size(); ++i)
      if (c.cluster[i] != g) indices.push_back(i);
  std::vector<double> variance(10, 0.0);
  for (const auto& [g, indices] : others) {
    const auto without = solve(subset(c, indices), truth.intrinsics.size);
    const auto e = testing::tangent_error(full.estimate, without.estimate);
    for (int i = 0; i < 10; ++i) variance[i] += e[i] * e[i];
  }
  const double g = double(others.size());
  EXPECT_EQ(full.clusters, others.size());
  for (int i = 0; i < 10; ++i)  // one Gauss-Newton step: second order of 0.01 px
    EXPECT_NEAR(full.covariance_clustered[i * 10 + i] / (variance[i] * (g - 1) / g), 1, 1e-3) << i;
}

TEST(Covariance, PredictsIndependentNoise) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  const auto clean = testing::scattered(truth, 1000, 2, 4, 0.3, random);
  constexpr int n = 300;
  const auto t = testing::run_trials(truth, clean, n, {}, [&](auto& c) { testing::add_noise(c, random); });
  EXPECT_EQ(t.not_ok, 0);
  EXPECT_NEAR(mean(t.mahalanobis_over_p), 1, 3 * std::sqrt(2.0 / (10 * n)));
  // An rms of n values with some 10 degrees each: 3 standard deviations are about 0.06; both covariances
  // hold.
  EXPECT_NEAR(root_mean_square(t.predicted) / root_mean_square(t.volume_rms), 1, 0.1);
  EXPECT_NEAR(root_mean_square(t.predicted_independent) / root_mean_square(t.volume_rms), 1, 0.1);
}

// Each block's points share an error. Independent noise would average away 20 times better than it does.
TEST(Covariance, ClusteredPredictsCorrelatedNoise) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  auto clean = testing::scattered(truth, 3200, 2, 4, 0.3, random);
  add_blocks(clean);
  const auto disturb = [&](Correspondences& c) {
    std::normal_distribution<double> normal;
    std::map<std::uint32_t, glm::dvec2> shared;
    for (std::size_t i = 0; i < c.cluster.size(); ++i) {
      const auto [at, is_new] = shared.try_emplace(c.cluster[i]);
      if (is_new) at->second = {0.3 * normal(random), 0.3 * normal(random)};
      c.projector_pixels[i] += at->second;
    }
  };
  const auto t = testing::run_trials(truth, clean, 100, {}, disturb);
  EXPECT_EQ(t.first.clusters, 160u);
  EXPECT_TRUE(t.first.clusters_suffice);
  const double sampled = root_mean_square(t.volume_rms);
  EXPECT_LT(mean(t.predicted_independent), sampled / 3);  // too small by about √20
  EXPECT_NEAR(mean(t.predicted) / sampled, 1, 0.2);       // 160 blocks and 100 trials
}

TEST(Covariance, RobustLossPredictsItsError) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  const auto clean = testing::scattered(truth, 1000, 2, 4, 0.3, random);
  SolveOptions options;
  options.loss = {RobustLoss::Kind::cauchy, 2};
  const auto t = testing::run_trials(truth, clean, 60, options, [&](auto& c) {
    testing::add_noise(c, random);
    testing::add_outliers(c, truth.intrinsics.size, 0.1, random);
  });
  EXPECT_EQ(t.not_ok, 0);
  EXPECT_NEAR(mean(t.predicted) / root_mean_square(t.volume_rms), 1, 0.25);  // 60 trials
}

}  // namespace
}  // namespace laterna
