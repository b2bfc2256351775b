#include "calib/solve.h"
#include "tests/calib/trials.h"
#include "tests/testing.h"

#include <gtest/gtest.h>

namespace laterna {
namespace {

TEST(SolveFull, TwoThousandTrialsAgreeWithTheCovariance) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  const auto clean = testing::scattered(truth, 1500, 2, 4, 0.3, random);
  constexpr int n = 2000, p = 10;
  const auto t = testing::run_trials(truth, clean, n, {}, [&](auto& c) { testing::add_noise(c, random); });
  EXPECT_EQ(t.not_ok, 0);
  EXPECT_NEAR(testing::mean(t.mahalanobis_over_p), 1, 3 * std::sqrt(2.0 / (p * n)));
  const auto& c = t.first.covariance_independent;
  for (int i = 0; i < p; ++i) {  // a sampled sigma scatters by 1/√(2n) = 1.6 %
    std::vector<double> e;
    for (const auto& error : t.errors) e.push_back(error[i]);
    EXPECT_NEAR(testing::root_mean_square(e) / std::sqrt(c[i * p + i]), 1, 0.1) << t.first.parameter_names[i];
  }
  for (const auto& x : image_grid(truth, {2, 3, 4})) {
    const auto sampled = testing::sampled_radii(truth, t.estimates, x);
    const auto predicted = testing::predicted_radii(truth, c, x);
    EXPECT_NEAR(sampled.x / predicted.x, 1, 0.1);
    EXPECT_NEAR(sampled.y / predicted.y, 1, 0.1);
  }
}

// Never silently wrong: over reliefs, noises and seeds an `ok` is within 5 times its prediction.
TEST(SolveFull, ThinReliefIsNeverSilentlyWrong) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  int ok = 0;
  for (int seed = 0; seed < 20; ++seed) {
    for (const double relief : {1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 1e-4, 1e-5, 1e-6}) {
      for (const double sigma : {0.01, 0.1, 0.5}) {
        auto c = testing::near_plane(truth, 500, 3, relief, sigma, random);
        testing::add_noise(c, random);
        const auto r = solve(c, truth.intrinsics.size);
        if (r.status != Status::ok) continue;
        ++ok;
        const auto v = verify(truth, r.estimate, r.covariance, c.world_points);
        EXPECT_LT(v.volume.rms, 5 * r.predicted_volume_rms_px) << relief << " " << sigma;
      }
    }
  }
  EXPECT_GT(ok, 100);
}

}  // namespace
}  // namespace laterna
