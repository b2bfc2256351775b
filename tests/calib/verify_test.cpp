#include "calib/verify.h"

#include "calib/projection_rows.h"
#include "sim/parallel.h"
#include "tests/calib/synthetic.h"
#include "tests/testing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;

LargeVector<glm::dvec3> surface(const Device& d, int n = 500) {
  auto random = testing::generator();
  return testing::scattered(d, n, 2, 4, 0.1, random).world_points;
}

TEST(Verify, DepthsByHand) {
  std::vector<double> lit;
  for (int i = 100; i >= 0; --i) lit.push_back(10 + i);  // percentiles 5 and 95: 15 and 105
  const auto volume = volume_depths(lit);
  ASSERT_EQ(volume.size(), 12u);
  EXPECT_DOUBLE_EQ(volume.front(), 15);
  EXPECT_DOUBLE_EQ(volume.back(), 105);
  EXPECT_DOUBLE_EQ(volume[1], 15 + 90.0 / 11);
  const auto outside = extrapolation_depths(lit);
  ASSERT_EQ(outside.size(), 12u);
  EXPECT_DOUBLE_EQ(outside[0], 8);
  EXPECT_DOUBLE_EQ(outside[5], 8 + 7 * 5.0 / 6);
  EXPECT_DOUBLE_EQ(outside[6], 105 + 32.5 / 6);
  EXPECT_DOUBLE_EQ(outside[11], 137.5);
}

TEST(Verify, PercentilesInterpolate) {
  EXPECT_DOUBLE_EQ(volume_depths({1, 2}).front(), 1.05);
  EXPECT_DOUBLE_EQ(volume_depths({2, 1}).back(), 1.95);
  EXPECT_DOUBLE_EQ(volume_depths({3}).front(), 3);
}

TEST(Verify, GridSpansTheImage) {
  const Device d = testing::usual_projector();
  const auto points = image_grid(d, {2, 5});
  ASSERT_EQ(points.size(), 16u * 12 * 2);
  const WorldProjection projection(d);
  const auto first = projection.project(points.front()), last = projection.project(points.back());
  EXPECT_NEAR(first.x, -0.5, 1e-10);  // rounding of pixels near 1000
  EXPECT_NEAR(first.y, -0.5, 1e-10);
  EXPECT_NEAR(first.z, 2, 1e-12);
  EXPECT_NEAR(last.x, 1279.5, 1e-10);
  EXPECT_NEAR(last.y, 799.5, 1e-10);
  EXPECT_NEAR(last.z, 5, 1e-12);
}

TEST(Verify, AShiftedPrincipalPointIsThatFarOffEverywhere) {
  const Device truth = testing::usual_projector();
  Device estimate = truth;
  estimate.intrinsics.cx += 3, estimate.intrinsics.cy -= 4;
  std::vector<double> covariance(100, 0.0);
  covariance[2 * 10 + 2] = 9, covariance[3 * 10 + 3] = 16;
  const auto v = verify(truth, estimate, covariance, surface(truth));
  for (const auto* s : {&v.surface, &v.volume, &v.extrapolation}) {
    EXPECT_NEAR(s->rms, 5, 1e-9);  // rounding of pixels near 1000
    EXPECT_NEAR(s->max, 5, 1e-9);
    EXPECT_NEAR(s->predicted_rms, 5, 1e-9);
    EXPECT_EQ(s->failed, 0u);
  }
  EXPECT_EQ(v.surface.points, 500u);
  EXPECT_EQ(v.volume.points, 2304u);
  EXPECT_EQ(v.extrapolation.points, 2304u);
  for (const auto& e : error_vectors(truth, estimate, surface(truth, 10))) {
    EXPECT_NEAR(e.x, 3, 1e-9);
    EXPECT_NEAR(e.y, -4, 1e-9);
  }
}

// A covariance of rank one along a small step predicts the error of that very step.
TEST(Verify, PredictionEqualsASmallStep) {
  Device truth = testing::usual_projector();
  truth.lens = {"LENSMODEL_OPENCV4", {-0.05, 0.02, 0.001, -0.001}};
  const std::vector<double> step = {2e-3, -1e-3, 1e-3,  3e-3, 1e-6, -2e-6, 1e-6,
                                    1e-6, 2e-6,  -1e-6, 3e-6, 1e-6, -4e-6, 2e-6};
  Device estimate = truth;
  auto& k = estimate.intrinsics;
  k.fx += step[0], k.fy += step[1], k.cx += step[2], k.cy += step[3];
  for (int i = 0; i < 4; ++i) estimate.lens.parameters[i] += step[4 + i];
  const Rigid turn = rigid_from_rotation_vector({step[8], step[9], step[10]}, glm::dvec3(0.0));
  estimate.device_from_world.rotation = turn.rotation * estimate.device_from_world.rotation;
  estimate.device_from_world.translation += glm::dvec3(step[11], step[12], step[13]);
  std::vector<double> covariance;
  for (const double a : step)
    for (const double b : step) covariance.push_back(a * b);
  const auto v = verify(truth, estimate, covariance, surface(truth));
  EXPECT_GT(v.volume.rms, 1e-3);
  EXPECT_NEAR(v.volume.predicted_rms / v.volume.rms, 1, 1e-4);  // second order of the step
  EXPECT_NEAR(v.surface.predicted_rms / v.surface.rms, 1, 1e-4);
}

TEST(Verify, PointsThatTheEstimateCannotProjectAreNotSkipped) {
  const Device truth = testing::usual_projector();
  Device estimate = truth;
  estimate.device_from_world.translation.z -= 3;  // the nearer half of the points falls behind
  const auto v = verify(truth, estimate, {}, surface(truth));
  EXPECT_GT(v.surface.failed, 100u);
  EXPECT_EQ(v.surface.rms, INFINITY);
  EXPECT_EQ(v.surface.max, INFINITY);
  EXPECT_EQ(v.volume.rms, INFINITY);
  EXPECT_TRUE(std::isnan(v.volume.predicted_rms));
}

TEST(Verify, SameBitsForAnyNumberOfThreads) {
  const Device truth = testing::usual_projector();
  Device estimate = truth;
  estimate.intrinsics.fx += 0.3;
  const auto points = surface(truth, 20000);
  const std::vector<double> covariance(100, 1e-6);
  set_thread_count(1);
  const auto one = verify(truth, estimate, covariance, points);
  set_thread_count(0);
  const auto many = verify(truth, estimate, covariance, points);
  EXPECT_EQ(one.surface.rms, many.surface.rms);
  EXPECT_EQ(one.surface.predicted_rms, many.surface.predicted_rms);
}

TEST(Verify, BadInput) {
  const Device truth = testing::usual_projector();
  Device other = truth;
  other.intrinsics.size = {640, 480};
  EXPECT_THAT(testing::input_error([&] { verify(truth, other, {}, surface(truth)); }), HasSubstr("640x480"));
  EXPECT_THAT(testing::input_error([&] {
                verify(truth, truth, {1, 2, 3}, surface(truth));
              }),
              HasSubstr("3 numbers, expected 10×10"));
  EXPECT_THAT(testing::input_error([&] { verify(truth, truth, {}, {}); }), HasSubstr("no surface point"));
}

}  // namespace
}  // namespace laterna
