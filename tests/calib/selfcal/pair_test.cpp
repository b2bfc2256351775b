#include "calib/selfcal/pair.h"

#include "tests/calib/selfcal/synthetic_tracks.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

using namespace laterna;
using namespace laterna::testing;

namespace {

TEST(Pair, FundamentalMatrixOfExactPoints) {
  auto random = generator();
  const TrackTruth t = one_pair(random, 60);
  const auto pairs = station_pairs(t.tracks);
  ASSERT_EQ(pairs.size(), 1u);
  const PairGeometry g = pair_geometry(pairs[0]);
  EXPECT_EQ(g.inliers, 60u);
  EXPECT_LT(g.epipolar_scale, 1e-6);  // 1e-7 px of rounding over 0.1 px
  EXPECT_FALSE(g.homography_explains);
}

TEST(Pair, ClosedFormFocalLengths) {
  auto random = generator();
  const TrackTruth t = one_pair(random, 60);
  const PairGeometry g = pair_geometry(station_pairs(t.tracks)[0]);
  const Intrinsics &a = t.rig.devices[0], &b = t.rig.devices[1];
  const auto f = squared_focal_lengths(g.fundamental, {a.cx, a.cy}, {b.cx, b.cy});
  EXPECT_NEAR(std::sqrt(f[0]), a.fx, 1e-3);  // 1e-7 px of rounding, 1e3 times as large where axes nearly meet
  EXPECT_NEAR(std::sqrt(f[1]), b.fx, 1e-3);
  EXPECT_GT(axes_miss_px(g.fundamental, {a.cx, a.cy}, {b.cx, b.cy}), 50);
}

TEST(Pair, AxesThatMeetDoNotMiss) {
  auto random = generator();
  const TrackTruth t =
      track_truth({test_camera(), test_projector()}, {0, 1},
                  {place_at({0, 0, 0}, {0, 0, 2.2}), place_at({0.7, 0.1, 0.2}, {0, 0, 2.2}, 0.1)},
                  bumpy_points(60, random));
  const PairGeometry g = pair_geometry(station_pairs(t.tracks)[0]);
  const Intrinsics &a = t.rig.devices[0], &b = t.rig.devices[1];
  EXPECT_LT(axes_miss_px(g.fundamental, {a.cx, a.cy}, {b.cx, b.cy}), 1e-4);
}

TEST(Pair, FewerThanEightCommonPointsAreNoPair) {
  auto random = generator();
  EXPECT_TRUE(station_pairs(one_pair(random, 7).tracks).empty());
}

}  // namespace
