#include "calib/selfcal/self_calibrate.h"

#include "tests/calib/selfcal/synthetic_tracks.h"
#include "tests/testing.h"

#include <gmock/gmock.h>
#include <Eigen/Dense>

using namespace laterna;
using namespace laterna::testing;
using ::testing::HasSubstr;

namespace {

std::string verdict(const SelfCalibration& c) {
  const char* words[] = {"ok", "weak", "refused"};
  return fmt::format("{}: {} (focal sigma {:.3g}, weakest {:.3g}, gap {:.3g}, scale {:.4g})",
                     words[int(c.status)], c.reason, c.focal_sigma, c.weakest_sigma, c.smallest_gap,
                     c.residual_scale);
}

// Without noise what is left is rounding through a bundle with a condition number of some 1e4.
void expect_truth(const SelfCalibration& c, const TrackRig& truth) {
  ASSERT_NE(c.status, Status::refused) << verdict(c);
  const std::vector<double> step = error_step(c, truth);
  for (std::size_t i = 0; i < step.size(); ++i) {
    const bool pixels = c.parameter_names[i].find('_') == std::string::npos;
    EXPECT_NEAR(step[i], 0, pixels ? 1e-3 : 1e-6) << c.parameter_names[i];  // 1e-6 of f = 1700
  }
}

TEST(SelfCalibrate, KnownCameraOnePairFocal) {
  auto random = generator();
  TrackTruth t = one_pair(random);
  forget(t.tracks, 1, false);
  const SelfCalibration c = self_calibrate(t.tracks);
  EXPECT_EQ(c.status, Status::ok) << verdict(c);
  expect_truth(c, t.rig);
  EXPECT_EQ(c.count.given, 7);
  EXPECT_EQ(c.count.needed(), 6);
}

TEST(SelfCalibrate, BothFocalsOnePairWithAxesThatMiss) {
  auto random = generator();
  TrackTruth t = one_pair(random);
  forget(t.tracks, 0, false), forget(t.tracks, 1, false);
  const SelfCalibration c = self_calibrate(t.tracks);
  expect_truth(c, t.rig);
}

TEST(SelfCalibrate, ProjectorInThreePlacesWithCenterFree) {
  auto random = generator();
  TrackTruth t = three_places(random);
  forget(t.tracks, 1, true);
  const SelfCalibration c = self_calibrate(t.tracks);
  EXPECT_EQ(c.status, Status::ok) << verdict(c);
  expect_truth(c, t.rig);
}

TEST(SelfCalibrate, TheSameFromPairsAlone) {
  // The scene is another one for each place of the projector: three baselines with lengths of their own.
  auto random = generator();
  TrackTruth t = three_places(random, 300);
  forget(t.tracks, 1, true);
  std::erase_if(t.tracks.sightings,
                [](const TrackSighting& s) { return s.station > 0 && s.station != 1 + s.point % 3; });
  const SelfCalibration c = self_calibrate(t.tracks);
  ASSERT_NE(c.status, Status::refused) << verdict(c);
  EXPECT_EQ(c.units.size(), 3u);
  const Intrinsics &k = c.rig.devices[1], &truth = t.rig.devices[1];
  EXPECT_NEAR(k.fx, truth.fx, 1e-3);
  EXPECT_NEAR(k.cx, truth.cx, 1e-3);
  EXPECT_NEAR(k.cy, truth.cy, 1e-3);
}

TEST(SelfCalibrate, NoiseStaysInsideItsCovariance) {
  auto random = generator();
  const TrackTruth t = three_places(random, 60, 0.2);
  int inside = 0, dof = 0;
  constexpr int seeds = 10;
  for (int seed = 0; seed < seeds; ++seed) {
    Tracks noisy = t.tracks;
    add_noise(noisy, random);
    forget(noisy, 1, true);
    const SelfCalibration c = self_calibrate(noisy);
    ASSERT_NE(c.status, Status::refused) << verdict(c);
    const std::vector<double> step = error_step(c, t.rig);
    const Eigen::Index n = Eigen::Index(step.size());
    const Eigen::Map<const Eigen::VectorXd> e(step.data(), n);
    const Eigen::Map<const Eigen::MatrixXd> cov(c.covariance.data(), n, n);
    // One direction, the scale, is fixed: the pseudo-inverse.
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(cov);
    double sum = 0;
    dof = 0;
    for (Eigen::Index i = 0; i < n; ++i)
      if (eigen.eigenvalues()[i] > 1e-13 * eigen.eigenvalues()[n - 1])
        sum += std::pow(eigen.eigenvectors().col(i).dot(e), 2) / eigen.eigenvalues()[i], ++dof;
    inside += sum < 41.4;  // the 99.7 % quantile of χ² with 20 degrees of freedom
  }
  EXPECT_EQ(dof, 20);
  EXPECT_GE(inside, seeds - 1);  // two or more outside: once in 2500 runs where the law holds
}

TEST(SelfCalibrate, OutliersAreNamed) {
  auto random = generator();
  TrackTruth t = three_places(random, 200, 0.2);
  add_noise(t.tracks, random);
  forget(t.tracks, 1, true);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::size_t spoilt = 0;
  for (TrackSighting& s : t.tracks.sightings)
    if (s.station > 0 && uniform(random) < 0.2)
      s.pixel = {1024 * uniform(random), 768 * uniform(random)}, ++spoilt;
  const SelfCalibration c = self_calibrate(t.tracks);
  ASSERT_NE(c.status, Status::refused) << verdict(c);
  const TrackColumns columns = columns_of(c.tracks);
  const std::vector<double> step = error_step(c, t.rig);
  for (const int at : columns.intrinsics[1]) EXPECT_LT(std::abs(step[at]), 5 * c.sigma[at]);
  EXPECT_GT(c.dropped.size(), 0.9 * double(spoilt));  // one in ten may lie where it is not seen
}

TEST(SelfCalibrate, SizeFromOneLength) {
  auto random = generator();
  TrackTruth t = one_pair(random);
  forget(t.tracks, 1, false);
  SelfCalibrationOptions options;
  options.length = KnownLength{3, 17, glm::length(t.rig.points[3] - t.rig.points[17])};
  const SelfCalibration c = self_calibrate(t.tracks, options);
  ASSERT_TRUE(c.metric) << verdict(c);
  const glm::dvec3 off = c.rig.station_from_first[1].translation - t.rig.station_from_first[1].translation;
  EXPECT_LT(glm::length(off), 1e-6);
}

// Degeneracies: each refused with its reason, whatever the seed, with and without noise.
class SelfCalibrateRefuses : public ::testing::TestWithParam<int> {
 protected:
  std::mt19937_64 random = generator();
  Tracks noisy(Tracks tracks) {
    if (GetParam() > 0) add_noise(tracks, random);
    return tracks;
  }
  void expect_refused(const Tracks& tracks, const char* reason) {
    const SelfCalibration c = self_calibrate(noisy(tracks));
    EXPECT_EQ(c.status, Status::refused) << verdict(c);
    EXPECT_THAT(c.reason, HasSubstr(reason));
  }
};

TEST_P(SelfCalibrateRefuses, APlane) {
  auto points = bumpy_points(200, random);
  for (glm::dvec3& x : points) x.z = 2.2 + 0.4 * x.x - 0.2 * x.y;
  for (const bool both : {false, true}) {
    TrackTruth t =
        track_truth({test_camera(), test_projector()}, {0, 1},
                    {place_at({0, 0, 0}, {0, 0.25, 2.2}), place_at({0.7, 0.1, 0.2}, {0, -0.2, 2.2})}, points);
    forget(t.tracks, 1, false);
    if (both) forget(t.tracks, 0, false);
    expect_refused(t.tracks, "the scene is a plane");
  }
}

TEST_P(SelfCalibrateRefuses, NoBaseline) {
  TrackTruth t = track_truth({test_camera(), test_projector()}, {0, 1},
                             {place_at({0, 0, 0}, {0, 0, 2.2}), place_at({0, 0, 0}, {0.1, 0.1, 2.2}, 0.2)},
                             bumpy_points(200, random));
  forget(t.tracks, 1, false);
  expect_refused(t.tracks, "no baseline");
}

TEST_P(SelfCalibrateRefuses, AxesThatMeet) {
  TrackDevice projector = test_projector();
  TrackTruth t = track_truth({test_camera(), projector}, {0, 1},
                             {place_at({0, 0, 0}, {0, 0, 2.2}), place_at({0.7, 0.1, 0.2}, {0, 0, 2.2}, 0.1)},
                             bumpy_points(300, random));
  forget(t.tracks, 0, false), forget(t.tracks, 1, false);
  expect_refused(t.tracks, "optical axes meet");
}

TEST_P(SelfCalibrateRefuses, OnlyTheSceneMoved) {
  TrackTruth t = one_pair(random, 300);
  forget(t.tracks, 1, true);
  expect_refused(t.tracks,
                 "one pair gives 7 numbers; known camera with unknown f, c_x, c_y of projector needs 8");
  // The same, with each scene's projector called another station.
  t.tracks.stations.push_back({1, "again"});
  for (TrackSighting& s : t.tracks.sightings)
    if (s.station == 1 && s.point % 2 == 1) s.station = 2;
  expect_refused(t.tracks, "only the scene moved; one pair gives 7 numbers");
}

TEST_P(SelfCalibrateRefuses, TooFewPoints) {
  TrackTruth t = one_pair(random, 6);
  forget(t.tracks, 1, false);
  expect_refused(t.tracks, "too few points");
}

INSTANTIATE_TEST_SUITE_P(Seeds, SelfCalibrateRefuses, ::testing::Range(0, 6));

}  // namespace
