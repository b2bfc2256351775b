#include "calib/selfcal/self_calibrate.h"

#include "calib/selfcal/held_out_points.h"
#include "calib/selfcal/sighting_cost.h"
#include "tests/calib/selfcal/synthetic_tracks.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <ceres/gradient_checker.h>
#include <Eigen/Dense>

using namespace laterna;
using namespace laterna::testing;
using ::testing::HasSubstr;

namespace {

const Lens k1_lens{"LENSMODEL_OPENCV4", {-0.12, 0, 0, 0}};
const Lens opencv4_lens{"LENSMODEL_OPENCV4", {-0.12, 0.1, 0.002, -0.003}};

std::string verdict(const SelfCalibration& c) {
  const char* words[] = {"ok", "weak", "refused"};
  std::string text = fmt::format("{}: {} (focal {:.3g}, lens {:.3g}, gap {:.3g}, scale {:.4g}, dropped {})",
                                 words[int(c.status)], c.reason, c.focal_sigma, c.lens_sigma, c.smallest_gap,
                                 c.residual_scale, c.dropped.size());
  for (const TrackRung& r : c.ladder.rungs)
    text += fmt::format("\n  {} {} fit {:.4f} held out {:.4f} gain {:.2f}", r.chosen ? "*" : " ", r.added,
                        r.fit_rms_px, r.held_out.rms_px, r.gain_over_error);
  return text;
}

// A projector with a lens in three places, its centre and the lens unknown.
TrackTruth with_lens(std::mt19937_64& random, const Lens& lens, int points = 200, double sigma_px = 0.1) {
  TrackDevice projector = test_projector();
  projector.lens = lens;
  return track_truth(
      {test_camera(), projector}, {0, 1, 1, 1},
      {place_at({0, 0, 0}, {0, 0, 2.2}), place_at({0.8, 0.1, 0.2}, {0, -0.3, 2.2}, 0.1),
       place_at({-0.7, -0.5, 0}, {0.1, -0.2, 2.3}, 1.3), place_at({0.2, 0.7, 0.3}, {0, -0.2, 2.1}, -0.6)},
      bumpy_points(points, random), sigma_px);
}

void forget_lens(Tracks& tracks, int device, const std::string& word) {
  tracks.devices[device].lens = {};
  set_lens_word(tracks.devices[device], word);
}

TEST(SightingCost, IsTheDerivativeOfItsResiduals) {
  auto random = generator();
  std::normal_distribution<double> normal;
  for (const bool one_focal : {false, true}) {
    for (const double angle : {0.0, 1e-5, 5e-3, 0.8, 3.0}) {
      const auto cost = sighting_cost(LensGradient("LENSMODEL_OPENCV4"), {0, 0, {300, 200}, 0.5}, one_focal);
      const std::vector<double> k{1.5, 1.6, 0.5, 0.4, -0.1, 0.05, 0.001, 0.002},
          place{0.6 * angle, -0.8 * angle, 0, 0.3, -0.2, 1.5}, x{0.2 * normal(random), 0.3, 0.1};
      const std::vector<const ceres::Manifold*>* const flat = nullptr;
      ceres::GradientChecker checker(cost.get(), flat, ceres::NumericDiffOptions());
      const double* blocks[] = {k.data(), place.data(), x.data()};
      ceres::GradientChecker::ProbeResults results;
      // Ridders' extrapolation of differences keeps 1e-8 of derivatives of a few thousand.
      EXPECT_TRUE(checker.Probe(blocks, 1e-7, &results)) << angle << "\n" << results.error_log;
    }
  }
}

TEST(TrackRig, RowsOfALensAreTheDerivatives) {
  auto random = generator();
  TrackTruth t = with_lens(random, opencv4_lens, 5);
  t.tracks.devices[1].lens_free.assign(4, true);
  const TrackColumns columns = columns_of(t.tracks);
  const std::vector<double> unit = natural_units(t.tracks, t.rig);
  std::vector<double> rows(2 * std::size_t(columns.count), 0.0);
  predict(t.tracks, columns, t.rig, 2, t.rig.points[1], rows.data());
  for (std::size_t i = 0; i < std::size_t(columns.count); ++i) {
    std::vector<double> step(columns.count, 0.0);
    step[i] = 1e-5 * unit[i];
    const auto plus = predict(t.tracks, columns, moved(t.tracks, t.rig, step), 2, t.rig.points[1]);
    step[i] *= -1;
    const auto minus = predict(t.tracks, columns, moved(t.tracks, t.rig, step), 2, t.rig.points[1]);
    for (int k = 0; k < 2; ++k)  // central differences of 1e-5: squared, of third derivatives near f = 1700
      EXPECT_NEAR(rows[std::size_t(k * columns.count) + i] * unit[i], ((*plus)[k] - (*minus)[k]) / 2e-5,
                  1e-4);
  }
}

TEST(SelfCalibrateLens, PlantedLensesComeBackWithoutNoise) {
  for (const auto& [lens, word] : {std::pair(k1_lens, "k1"), std::pair(opencv4_lens, "opencv4")}) {
    auto random = generator();
    TrackTruth t = with_lens(random, lens);
    forget(t.tracks, 1, true), forget_lens(t.tracks, 1, word);
    const SelfCalibration c = self_calibrate(t.tracks);
    EXPECT_EQ(c.status, Status::ok) << verdict(c);
    ASSERT_EQ(c.rig.lenses[1].size(), 4u);
    EXPECT_TRUE(c.dropped.empty()) << "what a pinhole had no room for has not come back: " << verdict(c);
    // Rounding of pixels, 1e-13, through a bundle with a condition number of some 1e5.
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(c.rig.lenses[1][i], lens.parameters[i], 1e-6) << verdict(c);
    EXPECT_NEAR(c.rig.devices[1].fx, t.rig.devices[1].fx, 1e-3);
    EXPECT_NEAR(c.rig.devices[1].cy, t.rig.devices[1].cy, 1e-3);
  }
}

TEST(SelfCalibrateLens, AKnownLensOfTheCameraIsTakenIntoAccount) {
  auto random = generator();
  TrackDevice camera = test_camera();
  camera.lens = {"LENSMODEL_OPENCV5", {-0.3, 0.1, 0.001, 0.002, -0.02}};
  TrackTruth t =
      track_truth({camera, test_projector()}, {0, 1},
                  {place_at({0, 0, 0}, {0.02, 0.25, 2.2}), place_at({0.7, 0.1, 0.2}, {0, -0.2, 2.2}, 0.1)},
                  bumpy_points(200, random));
  forget(t.tracks, 1, false);
  const SelfCalibration c = self_calibrate(t.tracks);
  EXPECT_EQ(c.status, Status::ok) << verdict(c);
  EXPECT_EQ(c.rig.lenses[0], camera.lens.parameters);
  EXPECT_NEAR(c.rig.devices[1].fx, t.rig.devices[1].fx, 1e-3);  // as without a lens
}

TEST(SelfCalibrateLens, NoiseStaysInsideItsCovariance) {
  auto random = generator();
  const TrackTruth t = with_lens(random, opencv4_lens, 60, 0.2);
  int inside = 0;
  constexpr int seeds = 5;
  for (int seed = 0; seed < seeds; ++seed) {
    Tracks noisy = t.tracks;
    add_noise(noisy, random);
    forget(noisy, 1, true), forget_lens(noisy, 1, "opencv4");
    const SelfCalibration c = self_calibrate(noisy);
    ASSERT_NE(c.status, Status::refused) << verdict(c);
    const std::vector<double> step = error_step(c, t.rig), unit = natural_units(c.tracks, c.rig);
    const Eigen::Index n = Eigen::Index(step.size());
    const Eigen::Map<const Eigen::VectorXd> u(unit.data(), n);
    const Eigen::VectorXd e = Eigen::Map<const Eigen::VectorXd>(step.data(), n).cwiseQuotient(u);
    const Eigen::MatrixXd cov = u.cwiseInverse().asDiagonal() *
                                Eigen::Map<const Eigen::MatrixXd>(c.covariance.data(), n, n) *
                                u.cwiseInverse().asDiagonal();
    // One direction, the scale, is fixed: the pseudo-inverse.
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(cov);
    double sum = 0;
    int dof = 0;
    for (Eigen::Index i = 0; i < n; ++i)
      if (eigen.eigenvalues()[i] > 1e-11 * eigen.eigenvalues()[n - 1])
        sum += std::pow(eigen.eigenvectors().col(i).dot(e), 2) / eigen.eigenvalues()[i], ++dof;
    EXPECT_EQ(dof, 24);
    inside += sum < 47.1;  // the 99.7 % quantile of χ² with 24 degrees of freedom
  }
  EXPECT_GE(inside, seeds - 1);  // two or more outside: once in 10,000 runs where the law holds
}

TEST(SelfCalibrateLens, AutoStaysAtAPinholeAndClimbsToALens) {
  for (const bool measured : {true, false}) {
    for (const bool distorted : {false, true}) {
      auto random = generator();
      TrackTruth t = with_lens(random, distorted ? k1_lens : Lens{}, 200, 0.2);
      add_noise(t.tracks, random);
      t.tracks.has_sigma = measured;
      forget(t.tracks, 1, true), forget_lens(t.tracks, 1, "auto"), forget_lens(t.tracks, 0, "auto");
      const SelfCalibration c = self_calibrate(t.tracks);
      EXPECT_EQ(c.status, Status::ok) << verdict(c);
      EXPECT_EQ(c.tracks.devices[0].lens_free_count(), 0) << verdict(c);
      const TrackColumns columns = columns_of(c.tracks);
      if (!distorted) {
        EXPECT_EQ(c.tracks.devices[1].lens_free_count(), 0) << verdict(c);
        continue;
      }
      ASSERT_GE(c.tracks.devices[1].lens_free_count(), 1) << verdict(c);
      const int at = columns.intrinsics[1][4];
      EXPECT_LT(std::abs(c.rig.lenses[1][0] + 0.12), 5 * c.sigma[at]) << verdict(c);
      EXPECT_LT(c.sigma[at], 0.02);
    }
  }
}

TEST(SelfCalibrateLens, APinholeOfALensIsNotSilent) {
  for (const bool measured : {true, false}) {
    auto random = generator();
    TrackTruth t = with_lens(random, {"LENSMODEL_OPENCV4", {-0.05, 0, 0, 0}}, 200, 0.2);
    add_noise(t.tracks, random);
    t.tracks.has_sigma = measured;
    forget(t.tracks, 1, true);
    t.tracks.devices[1].lens = {};
    const SelfCalibration c = self_calibrate(t.tracks);
    EXPECT_EQ(c.status, Status::weak) << verdict(c);
    EXPECT_THAT(c.reason, HasSubstr("follow a lens")) << verdict(c);
    EXPECT_THAT(c.reason, HasSubstr("of projector"));
  }
}

TEST(SelfCalibrateLens, APinholeOfAPinholeIsNotBlamed) {
  int ok = 0;
  auto random = generator();
  for (int seed = 0; seed < 5; ++seed) {
    TrackTruth t = with_lens(random, {}, 100, 0.2);
    add_noise(t.tracks, random);
    forget(t.tracks, 1, true);
    ok += self_calibrate(t.tracks).status == Status::ok;
  }
  EXPECT_EQ(ok, 5);  // the test blames one in 10⁵
}

TEST(SelfCalibrateLens, WhatOnePairCannotTell) {
  // A pair gives 7 numbers and the lens's own; the camera is known, the projector's f, cx, cy are not.
  auto random = generator();
  TrackTruth t = one_pair(random);
  forget(t.tracks, 1, true), forget_lens(t.tracks, 1, "k1");
  const SelfCalibration c = self_calibrate(t.tracks);
  EXPECT_EQ(c.status, Status::refused);
  EXPECT_THAT(c.reason, HasSubstr("one pair gives 8 numbers; known camera with unknown f, c_x, c_y, k1 of "
                                  "projector needs 9"));
}

TEST(SelfCalibrateLens, AnUndeterminedLensIsRefusedOrWeak) {
  // All points near the middle of the projector's image: k1 and more move nothing there.
  auto random = generator();
  TrackTruth t = with_lens(random, {}, 100, 0.3);
  std::erase_if(t.tracks.sightings, [&](const TrackSighting& s) {
    return s.station > 0 && glm::length(s.pixel - glm::dvec2(512, 700)) > 250;
  });
  add_noise(t.tracks, random);
  forget(t.tracks, 1, false), forget_lens(t.tracks, 1, "opencv8");
  t.tracks.devices[1].intrinsics.cy = 700;
  const SelfCalibration c = self_calibrate(t.tracks);
  EXPECT_NE(c.status, Status::ok) << verdict(c);
  EXPECT_GT(c.lens_sigma, 0.02) << verdict(c);
}

TEST(HoldOutPoints, BlocksAreEvenAndForecastTheNoise) {
  auto random = generator();
  TrackTruth t = with_lens(random, {}, 160, 0.2);
  forget(t.tracks, 1, true);
  add_noise(t.tracks, random);
  const double unit = glm::length(t.rig.station_from_first[1].translation);
  for (Rigid& place : t.rig.station_from_first) place.translation /= unit;
  for (glm::dvec3& x : t.rig.points) x /= unit;
  const auto a = adjust_tracks(t.tracks, t.rig, {{0, 1}});
  ASSERT_TRUE(a);
  const std::vector<int> block = point_blocks(a->rig);
  for (int b = 0; b < 8; ++b) EXPECT_EQ(std::count(block.begin(), block.end(), b), 20) << b;
  const HeldOut held_out = hold_out_points(t.tracks, a->rig, {{0, 1}});
  EXPECT_EQ(held_out.folds.size(), 8u);
  EXPECT_TRUE(held_out.failed.empty());
  // Four sightings leave 5 of 8 numbers beside the point: 0.2·sqrt(2·5/8), sampled to 5 % by 800 of them.
  EXPECT_NEAR(held_out.rms_px, 0.2 * std::sqrt(1.25), 0.05 * 0.2236);
}

}  // namespace
