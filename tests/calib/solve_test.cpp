#include "calib/solve.h"

#include "sim/parallel.h"
#include "tests/calib/synthetic.h"
#include "tests/testing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;

double volume_rms(const Device& truth, const SolveResult& r, const Correspondences& c) {
  return verify(truth, r.estimate, r.covariance, c.world_points).volume.rms;
}

// ok: right. weak or refused: with a reason. Rounding of pixels near 1000 leaves 1e-6 at most in thin relief.
void expect_honest(const Device& truth, const SolveResult& r, const Correspondences& c, const char* what) {
  if (r.status == Status::ok) {
    EXPECT_LT(volume_rms(truth, r, c), 5 * r.predicted_volume_rms_px + 1e-6) << what;
  } else {
    EXPECT_FALSE(r.reason.empty()) << what;
  }
}

struct Case {
  const char* name;
  Device truth;
  double near_m, far_m, bound_px;
};

double focal_of(double fov_deg, double width) {
  return width / 2 / std::tan(fov_deg * std::numbers::pi / 360);
}

std::vector<Case> cases() {
  using testing::projector;
  const Rigid pose = testing::usual_projector().device_from_world;
  const Rigid flipped = compose(rigid_from_rotation_vector({0, 0, std::numbers::pi}, glm::dvec3(0.0)), pose);
  const Rigid portrait =
      compose(rigid_from_rotation_vector({0, 0, std::numbers::pi / 2}, glm::dvec3(0.0)), pose);
  const Rigid far = compose(pose, Rigid{glm::dmat3(1.0), {1e6, -1e6, 1e6}});
  std::vector<Case> all = {
      {"usual", testing::usual_projector(), 2, 4, 1e-8},
      {"shift of 100 % of the height", projector({1920, 1080}, 2843, {960, 539.5 + 1080}, pose), 2, 4, 1e-8},
      {"shift to the side and up", projector({1920, 1080}, 2843, {-700, -500}, pose), 2, 4, 1e-8},
      {"portrait", projector({1920, 1080}, 2843, {960, 1096}, portrait), 2, 4, 1e-8},
      {"portrait panel", projector({1080, 1920}, 2843, {540, 960}, pose), 2, 4, 1e-8},
      {"upside down", projector({1920, 1080}, 2843, {960, 1096}, flipped), 2, 4, 1e-8},
      {"100 degrees", projector({1920, 1080}, focal_of(100, 1920), {959.5, 539.5}, pose), 1, 4, 1e-8},
      {"2 degrees", projector({1920, 1080}, focal_of(2, 1920), {959.5, 539.5}, pose), 30, 60, 1e-6},
      // World points are rounded by 1e-10 m, and the pose by as much: 1e-7 px at 3 m; the bound leaves a
      // factor 10.
      {"a million metres away", projector({1920, 1080}, 2843, {960, 1096}, far), 2, 4, 2e-6}};
  Device lens = testing::usual_projector();
  lens.lens = {"LENSMODEL_OPENCV4", {-0.05, 0.02, 0.001, -0.002}};
  all.push_back({"OPENCV4", lens, 2, 4, 1e-8});
  lens.lens = {"LENSMODEL_OPENCV5", {-0.0485, -0.194, 0.001, -0.0005, 0.738}};
  all.push_back({"OPENCV5", lens, 2, 4, 1e-8});
  return all;
}

TEST(Solve, RecoversTheProjectorFromExactPoints) {
  auto random = testing::generator();
  for (const auto& k : cases()) {
    const auto c = testing::scattered(k.truth, 1000, k.near_m, k.far_m, 0.1, random);
    SolveOptions options;
    options.lens_model = k.truth.lens.model;
    const auto r = solve(c, k.truth.intrinsics.size, options);
    EXPECT_EQ(r.status, Status::ok) << k.name << ": " << r.reason;
    EXPECT_LE(volume_rms(k.truth, r, c), k.bound_px) << k.name;
    EXPECT_LE(r.fit_rms_px, k.bound_px) << k.name;
    EXPECT_EQ(r.parameter_names.size(), 10 + k.truth.lens.parameters.size());
    EXPECT_EQ(r.sigma.size(), r.parameter_names.size());
  }
}

TEST(Solve, SixExactPointsAreEnough) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  const auto c = testing::scattered(truth, 6, 2, 4, 0.1, random);
  const auto r = solve(c, truth.intrinsics.size);
  ASSERT_NE(r.status, Status::refused) << r.reason;
  EXPECT_LT(volume_rms(truth, r, c), 1e-6);  // the condition of six points
  EXPECT_FALSE(r.clusters_suffice);
}

TEST(Solve, AStartThatTheUserGives) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  const auto c = testing::scattered(truth, 200, 2, 4, 0.1, random);
  SolveOptions options;
  options.start = truth;
  options.start->intrinsics.fx *= 1.2, options.start->intrinsics.fy *= 1.2;
  EXPECT_LT(volume_rms(truth, solve(c, truth.intrinsics.size, options), c), 1e-8);
  options.lens_model = "LENSMODEL_OPENCV4";
  EXPECT_THAT(testing::input_error([&] { solve(c, truth.intrinsics.size, options); }),
              HasSubstr("expected LENSMODEL_OPENCV4"));
}

TEST(Solve, SameBitsForAnyNumberOfThreads) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  auto c = testing::scattered(truth, 12000, 2, 4, 0.3, random);
  testing::add_noise(c, random);
  testing::add_outliers(c, truth.intrinsics.size, 0.1, random);
  SolveOptions options;
  options.loss.kind = RobustLoss::Kind::cauchy;
  set_thread_count(1);
  const auto one = solve(c, truth.intrinsics.size, options);
  set_thread_count(0);
  const auto many = solve(c, truth.intrinsics.size, options);
  EXPECT_EQ(one.estimate.intrinsics.fx, many.estimate.intrinsics.fx);
  EXPECT_EQ(one.estimate.device_from_world.translation, many.estimate.device_from_world.translation);
  EXPECT_EQ(one.covariance, many.covariance);
}

TEST(Solve, ManyPointsChooseTheirStartOnFewer) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  auto c = testing::scattered(truth, 50000, 2, 4, 0.3, random);
  testing::add_noise(c, random);
  const auto r = solve(c, truth.intrinsics.size);
  EXPECT_EQ(r.status, Status::ok) << r.reason;
  EXPECT_NEAR(r.reduced_chi2, 1, 5 * std::sqrt(1.0 / 50000));  // 5 standard deviations
  EXPECT_LT(volume_rms(truth, r, c), 3 * r.predicted_volume_rms_px);
}

TEST(Solve, CountsWhatItSees) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  auto c = testing::scattered(truth, 2000, 2, 4, 0.3, random);
  testing::add_noise(c, random);
  const auto r = solve(c, truth.intrinsics.size);
  EXPECT_NEAR(r.fit_rms_px, 0.3 * std::sqrt(2.0), 0.03);
  EXPECT_NEAR(r.reduced_chi2, 1, 5 * std::sqrt(1.0 / 2000));
  EXPECT_NEAR(r.residual_scale, 1, 0.06);
  EXPECT_LT(r.outlier_share, 0.006);
  EXPECT_GT(r.iterations, 0);
  EXPECT_FALSE(r.termination.empty());
  EXPECT_EQ(r.scaled_singular_values.size(), 10u);
  EXPECT_EQ(r.clusters, 2000u);
}

// ---- what cannot be told

TEST(Solve, RefusesWhatDoesNotDetermineAProjector) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  const auto refusal = [&](const Correspondences& c) {
    const auto r = solve(c, truth.intrinsics.size);
    EXPECT_EQ(r.status, Status::refused);
    return r.reason;
  };
  EXPECT_THAT(refusal({}), HasSubstr("0 correspondences"));
  EXPECT_THAT(refusal(testing::scattered(truth, 5, 2, 4, 0.1, random)), HasSubstr("5 correspondences"));
  EXPECT_THAT(refusal(testing::near_plane(truth, 500, 3, 0, 0.1, random)), HasSubstr("one plane"));
  auto c = testing::scattered(truth, 100, 2, 4, 0.1, random);
  for (auto& x : c.world_points) x = c.world_points[0];
  EXPECT_THAT(refusal(c), HasSubstr("same point"));
  for (int i = 0; i < 100; ++i) c.world_points[i] = glm::dvec3(0, 0, 3) + glm::dvec3(1, 2, 3) * (0.01 * i);
  EXPECT_THAT(refusal(c), HasSubstr("one line"));
  // Five places, each seen many times: duplicates are no new information.
  c = testing::scattered(truth, 5, 2, 4, 0.1, random);
  std::vector<std::size_t> again;
  for (std::size_t i = 0; i < 100; ++i) again.push_back(i % 5);
  EXPECT_THAT(refusal(subset(c, again)), HasSubstr("100 correspondences at 5 different world points"));
}

TEST(Solve, DuplicatesOfEnoughPointsAreHarmless) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  const auto c = testing::scattered(truth, 50, 2, 4, 0.1, random);
  std::vector<std::size_t> again;
  for (std::size_t i = 0; i < 200; ++i) again.push_back(i % 50);
  const auto r = solve(subset(c, again), truth.intrinsics.size);
  EXPECT_EQ(r.status, Status::ok) << r.reason;
  EXPECT_LT(volume_rms(truth, r, c), 1e-8);
}

TEST(Solve, RefusesMirroredAndBehind) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  auto mirrored = testing::scattered(truth, 500, 2, 4, 0.3, random);
  testing::add_noise(mirrored, random);
  for (auto& p : mirrored.projector_pixels) p.x = truth.intrinsics.size.x - 1 - p.x;
  auto behind = testing::scattered(truth, 500, 2, 4, 0.3, random);
  const glm::dvec3 center = center_in_world(truth.device_from_world);
  for (std::size_t i = 0; i < 100; ++i) behind.world_points[i] = 2.0 * center - behind.world_points[i];
  for (const auto kind : {RobustLoss::Kind::none, RobustLoss::Kind::cauchy}) {
    SolveOptions options;
    options.loss.kind = kind;
    auto r = solve(mirrored, truth.intrinsics.size, options);
    EXPECT_EQ(r.status, Status::refused);
    EXPECT_THAT(r.reason, HasSubstr("mirrored"));
    r = solve(behind, truth.intrinsics.size, options);
    EXPECT_EQ(r.status, Status::refused);
    EXPECT_THAT(r.reason, HasSubstr("behind"));
  }
}

TEST(Solve, ThinReliefIsRightOrWeakOrRefused) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  int weak_or_refused = 0;
  for (const double relief : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    auto c = testing::near_plane(truth, 1000, 3, relief, 0.1, random);
    expect_honest(truth, solve(c, truth.intrinsics.size), c, "exact");
    testing::add_noise(c, random);
    const auto r = solve(c, truth.intrinsics.size);
    expect_honest(truth, r, c, "noisy");
    if (relief > 1e-3) {
      EXPECT_EQ(r.status, Status::ok) << r.reason;
    }
    if (relief < 5e-3) {
      EXPECT_NE(r.status, Status::ok) << relief;
    }
    if (relief < 5e-3) {
      EXPECT_THAT(r.reason, HasSubstr("% of the throw"));
    }
    weak_or_refused += r.status != Status::ok;
  }
  EXPECT_EQ(weak_or_refused, 4);
}

// A plane whose points are rounded to floats: a relief of 1e-7 that means nothing.
TEST(Solve, APlaneInFloatsIsNotBelieved) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  auto c = testing::near_plane(truth, 1000, 3, 0, 0.1, random);
  testing::add_noise(c, random);
  for (auto& x : c.world_points) x = glm::dvec3(glm::vec3(x));
  const auto r = solve(c, truth.intrinsics.size);
  EXPECT_NE(r.status, Status::ok);
  EXPECT_FALSE(r.reason.empty());
}

TEST(Solve, OutliersAreWeakWithoutALossAndHeldWithCauchy) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  for (const double share : {0.01, 0.1, 0.4}) {
    auto c = testing::scattered(truth, 1000, 2, 4, 0.3, random);
    testing::add_noise(c, random);
    testing::add_outliers(c, truth.intrinsics.size, share, random);
    const auto plain = solve(c, truth.intrinsics.size);
    EXPECT_EQ(plain.status, Status::weak) << share;
    EXPECT_THAT(plain.reason, HasSubstr("times what the sigmas explain"));
    for (const auto kind : {RobustLoss::Kind::huber, RobustLoss::Kind::cauchy}) {
      SolveOptions options;
      options.loss.kind = kind;
      const auto r = solve(c, truth.intrinsics.size, options);
      if (kind == RobustLoss::Kind::huber && share > 0.3) {
        EXPECT_EQ(r.status, Status::weak);
        EXPECT_THAT(r.reason, HasSubstr("more than this loss bears"));
        continue;
      }
      EXPECT_EQ(r.status, Status::ok) << share << r.reason;
      // Noise alone predicts; three times it leaves room for chance and for Huber's pull.
      EXPECT_LT(volume_rms(truth, r, c), 3 * r.predicted_volume_rms_px) << share;
      EXPECT_NEAR(r.outlier_share, share, 0.05);
    }
  }
}

TEST(Solve, AnUnmodelledLensIsWeak) {
  auto random = testing::generator();
  Device truth = testing::usual_projector();
  truth.lens = {"LENSMODEL_OPENCV4", {-0.05, 0.02, 0, 0}};
  auto c = testing::scattered(truth, 1000, 2, 4, 0.1, random);
  testing::add_noise(c, random);
  const auto r = solve(c, truth.intrinsics.size);
  EXPECT_EQ(r.status, Status::weak);
  EXPECT_THAT(r.reason, HasSubstr("lens distortion"));
}

TEST(Solve, FewBlocksAreWeak) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  auto c = testing::scattered(truth, 1000, 2, 4, 0.1, random);
  testing::add_noise(c, random);
  for (std::size_t i = 0; i < 1000; ++i) c.cluster.push_back(std::uint32_t(i % 12) * 77);
  const auto r = solve(c, truth.intrinsics.size);
  EXPECT_EQ(r.status, Status::weak);
  EXPECT_THAT(r.reason, HasSubstr("only 12 blocks"));
  EXPECT_GE(r.predicted_volume_rms_px, r.predicted_volume_rms_independent_px);
}

TEST(Solve, NotConvergedIsRefused) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  auto c = testing::scattered(truth, 1000, 2, 4, 0.3, random);
  testing::add_noise(c, random);
  SolveOptions options;
  options.max_iterations = 1;
  const auto r = solve(c, truth.intrinsics.size, options);
  EXPECT_EQ(r.status, Status::refused);
  EXPECT_THAT(r.reason, HasSubstr("did not converge"));
}

TEST(Solve, BadInput) {
  auto random = testing::generator();
  const Device truth = testing::usual_projector();
  const auto good = testing::scattered(truth, 20, 2, 4, 0.1, random);
  auto c = good;
  c.projector_pixels[3].x = std::nan("");
  EXPECT_THAT(testing::input_error([&] { solve(c, {1280, 800}); }), HasSubstr("correspondence 3"));
  EXPECT_THAT(testing::input_error([&] { solve(good, {0, 800}); }), HasSubstr("projector"));
  SolveOptions options;
  options.lens_model = "LENSMODEL_FISH";
  EXPECT_THAT(testing::input_error([&] { solve(good, {1280, 800}, options); }), HasSubstr("LENSMODEL_FISH"));
  options = {};
  options.tolerance_px = 0;
  EXPECT_THAT(testing::input_error([&] { solve(good, {1280, 800}, options); }), HasSubstr("tolerance"));
  options = {};
  options.loss.scale_sigmas = -1;
  EXPECT_THAT(testing::input_error([&] { solve(good, {1280, 800}, options); }), HasSubstr("scale -1"));
}

}  // namespace
}  // namespace laterna
