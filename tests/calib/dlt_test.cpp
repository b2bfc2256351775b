#include "calib/dlt.h"

#include "sim/parallel.h"
#include "tests/calib/synthetic.h"
#include "tests/testing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;

Device device_of(const DltResult& r) {
  Device d;
  d.name = "dlt";
  d.intrinsics = r.intrinsics;
  d.device_from_world = r.device_from_world;
  return d;
}

double volume_rms(const Device& truth, const DltResult& r, const Correspondences& c) {
  return verify(truth, device_of(r), {}, c.world_points).volume.rms;
}

TEST(Dlt, ExactPoints) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  for (const int n : {6, 7, 20, 1000}) {
    const auto c = testing::scattered(truth, n, 2, 4, 0.1, random);
    const auto r = dlt(c, truth.intrinsics.size);
    ASSERT_EQ(r.status, DltStatus::ok) << r.reason;
    EXPECT_LT(volume_rms(truth, r, c), 1e-7) << n;  // rounding times the condition of six points
    EXPECT_LT(r.uniqueness, 1e-10);
    EXPECT_LT(std::abs(r.skew_px), 1e-7);
  }
}

TEST(Dlt, FarFromTheOrigin) {
  auto random = testing::generator();
  Device truth = testing::usual_projector();
  truth.device_from_world = compose(truth.device_from_world, Rigid{glm::dmat3(1.0), {1e6, -1e6, 1e6}});
  const auto c = testing::scattered(truth, 500, 2, 4, 0.1, random);
  const auto r = dlt(c, truth.intrinsics.size);
  ASSERT_EQ(r.status, DltStatus::ok) << r.reason;
  EXPECT_LT(volume_rms(truth, r, c), 1e-5);  // world points are rounded by 1e-10 m, 1e-7 px
}

TEST(Dlt, NoiseLeavesPixelsOfTheirSigma) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  auto c = testing::scattered(truth, 2000, 2, 4, 0.3, random);
  testing::add_noise(c, random);
  const auto r = dlt(c, truth.intrinsics.size);
  ASSERT_EQ(r.status, DltStatus::ok);
  EXPECT_NEAR(r.rms_px, 0.3 * std::sqrt(2.0), 0.02);  // 3 standard deviations of an rms over 4000 numbers
  EXPECT_LT(volume_rms(truth, r, c), 0.1);  // about six times the bound's 0.03, which DLT nearly reaches
}

TEST(Dlt, MirroredAndBehind) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  auto c = testing::scattered(truth, 100, 2, 4, 0.1, random);
  for (auto& p : c.projector_pixels) p.x = truth.intrinsics.size.x - 1 - p.x;
  const auto mirrored = dlt(c, truth.intrinsics.size);
  EXPECT_EQ(mirrored.status, DltStatus::mirrored);
  EXPECT_THAT(mirrored.reason, HasSubstr("mirrored"));

  c = testing::scattered(truth, 100, 2, 4, 0.1, random);
  const glm::dvec3 center = center_in_world(truth.device_from_world);
  for (int i = 0; i < 30; ++i)
    c.world_points[i] = 2.0 * center - c.world_points[i];  // same pixels, from behind
  const auto both = dlt(c, truth.intrinsics.size);
  EXPECT_EQ(both.status, DltStatus::both_sides);
  EXPECT_THAT(both.reason, HasSubstr("30 of 100"));
}

TEST(Dlt, AnExactPlaneIsDegenerate) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  const auto r = dlt(testing::near_plane(truth, 200, 3, 0, 0.1, random), truth.intrinsics.size);
  EXPECT_EQ(r.status, DltStatus::degenerate);
  EXPECT_THAT(r.reason, HasSubstr("no clear single solution"));
}

TEST(RansacDlt, FindsTheProjectorAmongOutliers) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  auto c = testing::scattered(truth, 1000, 2, 4, 0.3, random);
  testing::add_noise(c, random);
  testing::add_outliers(c, truth.intrinsics.size, 0.4, random);
  const auto r = ransac_dlt(c, truth.intrinsics.size);
  ASSERT_EQ(r.status, DltStatus::ok) << r.reason;
  EXPECT_LT(volume_rms(truth, r, c), 0.3);  // one sigma; noise alone gives some 0.04
  EXPECT_NEAR(double(r.inliers.size()), 600, 60);
}

TEST(RansacDlt, SameSeedSameBits) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  auto c = testing::scattered(truth, 500, 2, 4, 0.3, random);
  testing::add_noise(c, random);
  testing::add_outliers(c, truth.intrinsics.size, 0.3, random);
  set_thread_count(1);
  const auto one = ransac_dlt(c, truth.intrinsics.size);
  set_thread_count(0);
  const auto many = ransac_dlt(c, truth.intrinsics.size);
  EXPECT_EQ(one.inliers, many.inliers);
  EXPECT_EQ(one.intrinsics.fx, many.intrinsics.fx);
}

TEST(RansacDlt, NothingAgrees) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  auto c = testing::scattered(truth, 100, 2, 4, 1e-3, random);
  testing::add_outliers(c, truth.intrinsics.size, 1.0, random);
  RansacOptions few;
  few.max_trials = 200;
  const auto r = ransac_dlt(c, truth.intrinsics.size, few);
  EXPECT_LT(r.inliers.size(), 15u);  // what six free points and chance can gather
}

}  // namespace
}  // namespace laterna
