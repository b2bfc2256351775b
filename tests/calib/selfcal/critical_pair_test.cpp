#include "calib/selfcal/critical_pair.h"

#include "tests/calib/selfcal/synthetic_tracks.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

using namespace laterna;
using namespace laterna::testing;
using ::testing::HasSubstr;
using ::testing::Not;

namespace {

// A pair whose centres, (0, 0, 0) and (0.7, 0.1, 0.2), lie on the ruled quadric z·(z - 2.2) + x·(1.5y + d) =
// 0, as all points do but for what they stand off it.
TrackTruth critical_rig(std::mt19937_64& random, double off) {
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  const double d = 0.4 / 0.7 - 0.15;
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 250; ++i) {
    const double x = 1.2 * uniform(random), y = 0.8 * uniform(random);
    points.emplace_back(x, y, 1.1 + std::sqrt(1.21 - x * (1.5 * y + d)) + off * uniform(random));
  }
  return track_truth({test_camera(), test_projector()}, {0, 1},
                     {place_at({0, 0, 0}, {0.02, 0.25, 2.2}), place_at({0.7, 0.1, 0.2}, {0, -0.2, 2.2}, 0.1)},
                     points);
}

TEST(CriticalPair, PointsOnTheQuadricHaveAnotherMatrix) {
  auto random = generator();
  for (const double off : {0.0, 0.3}) {
    TrackTruth t = critical_rig(random, off);
    add_noise(t.tracks, random);
    const auto pairs = station_pairs(t.tracks);
    ASSERT_EQ(pairs.size(), 1u);
    const PairGeometry geometry = pair_geometry(pairs[0]);
    EXPECT_FALSE(geometry.homography_explains);  // it is no plane
    EXPECT_EQ(on_critical_surface(pairs[0], geometry), off == 0)
        << *other_matrix_scale(pairs[0], geometry.fundamental) << " of " << geometry.epipolar_scale;
  }
}

TEST(CriticalPair, SelfCalibrationSaysIt) {
  auto random = generator();
  for (const bool noisy : {false, true}) {
    TrackTruth t = critical_rig(random, 0);
    if (noisy) add_noise(t.tracks, random);
    forget(t.tracks, 1, false);
    const SelfCalibration c = self_calibrate(t.tracks);
    EXPECT_NE(c.status, Status::ok);
    EXPECT_THAT(c.reason, HasSubstr("a critical surface: a quadric through the centres of camera at 0 and"));
    EXPECT_THAT(c.reason, Not(HasSubstr("plane")));
  }
}

}  // namespace
