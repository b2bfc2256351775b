#include "calib/boards/adjust.h"

#include "calib/boards/rig_covariance.h"
#include "calib/boards/stepwise.h"
#include "tests/calib/boards/synthetic_boards.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>

namespace laterna {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

testing::BoardTruth usual(std::mt19937_64& random) {
  testing::BoardScene scene;
  scene.camera_terms = scene.projector_terms = {"k1"};
  scene.camera_lens = {-0.2, 0, 0, 0};
  scene.projector_lens = {-0.06, 0, 0, 0};
  return testing::board_truth(scene, random);
}

BoardRig disturbed(const testing::BoardTruth& t) {
  const RigColumns columns = columns_of(t.model);
  std::vector<double> step(columns.count, 0.01), poses(6 * t.rig.camera_from_board.size(), 0.01);
  for (const RigColumns::Of& of : columns.devices)
    for (int i = 0; i < 4; ++i)
      if (of.intrinsics[i] >= 0) step[of.intrinsics[i]] = 30;
  return moved(t.rig, columns, step, poses);
}

// Largest difference of a pixel over all sightings.
double largest_difference(const RigProblem& problem, const BoardRig& a, const BoardRig& b) {
  double most = 0, p[2], q[2];
  for (const Sighting& s : problem.sightings) {
    EXPECT_TRUE(predict(problem, a, s, p, nullptr) && predict(problem, b, s, q, nullptr));
    most = std::max(most, std::hypot(p[0] - q[0], p[1] - q[1]));
  }
  return most;
}

TEST(Adjust, CleanDataGiveTheTruth) {
  auto random = testing::generator();
  const auto t = usual(random);
  const RigProblem problem(t.capture, t.model);
  const auto a = adjust(problem, disturbed(t));
  ASSERT_TRUE(a);
  EXPECT_TRUE(a->converged) << a->termination;
  EXPECT_LT(a->loss, 1e-12);  // sightings carry rounding of some 1e-12 px
  const auto step = global_step(t.rig, a->rig, columns_of(t.model));
  for (const double s : step) EXPECT_NEAR(s, 0, 1e-6);  // px; the weakest direction amplifies rounding
}

// At the minimum the gradient of all parameters vanishes, by rows that know nothing of blocks or factors.
TEST(Adjust, TheGradientVanishesWhereItStops) {
  auto random = testing::generator();
  auto t = usual(random);
  t.model.bend = true;
  t.capture = testing::with_noise(t.capture, random);
  for (const auto kind : {RobustLoss::Kind::none, RobustLoss::Kind::cauchy}) {
    const RigProblem problem(t.capture, t.model, {kind, 2});
    const auto a = adjust(problem, disturbed(t));
    ASSERT_TRUE(a && a->converged);
    const int n = problem.row_columns() - 1, g = problem.columns.count;
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(g + 6 * problem.pose_count()), curvature = gradient;
    for (const Sighting& s : problem.sightings) {
      double pixel[2];
      Matrix row(2, n);
      ASSERT_TRUE(predict(problem, a->rig, s, pixel, row.data()));
      row /= s.sigma_px;
      const Eigen::Vector2d r = Eigen::Vector2d(pixel[0] - s.pixel.x, pixel[1] - s.pixel.y) / s.sigma_px;
      const double w = problem.loss.weight(r.squaredNorm());
      const Eigen::VectorXd part = w * row.transpose() * r, square = row.colwise().squaredNorm();
      gradient.head(g) += part.tail(g), curvature.head(g) += square.tail(g);
      gradient.segment(g + 6 * s.pose, 6) += part.head(6);
      curvature.segment(g + 6 * s.pose, 6) += square.head(6);
    }
    // In units of each parameter's own sigma (if the others were known): far below a sigma.
    for (Eigen::Index i = 0; i < gradient.size(); ++i)
      EXPECT_LT(std::abs(gradient[i]) / std::sqrt(curvature[i]), 1e-4) << i;
  }
}

TEST(Adjust, RestrictedLensesStayRestricted) {
  auto random = testing::generator();
  auto t = usual(random);
  t.model.devices[1].one_focal_length = t.model.devices[1].fixed_center = true;
  const BoardRig start = fitted_to(t.rig, t.model, t.capture);
  const auto a = adjust({testing::with_noise(t.capture, random), t.model}, start);
  ASSERT_TRUE(a);
  const auto& k = a->rig.devices[1].parameters;
  EXPECT_EQ(k[0], k[1]);
  EXPECT_EQ(k[2], 511.5);
  EXPECT_EQ(k[3], 383.5);
  EXPECT_NE(k[4], start.devices[1].parameters[4]);
  for (int i = 5; i < 8; ++i) EXPECT_EQ(k[i], 0);
}

TEST(Adjust, HeldPosesStay) {
  auto random = testing::generator();
  auto t = usual(random);
  t.model.hold_poses = true;
  t.model.devices[0].held = true;
  const auto a = adjust({testing::with_noise(t.capture, random), t.model}, t.rig);
  ASSERT_TRUE(a);
  EXPECT_EQ(a->rig.camera_from_board[2].translation, t.rig.camera_from_board[2].translation);
  EXPECT_EQ(a->rig.devices[0].parameters, t.rig.devices[0].parameters);
  EXPECT_NE(a->rig.devices[1].parameters, t.rig.devices[1].parameters);
}

TEST(Adjust, AStartWithAPointBehindIsRefused) {
  auto random = testing::generator();
  auto t = usual(random);
  t.rig.camera_from_board[0].translation.z = -3;
  EXPECT_FALSE(adjust({t.capture, t.model}, t.rig));
}

TEST(Adjust, StepwiseAgreesOnCleanData) {
  auto random = testing::generator();
  const auto t = usual(random);
  const auto stepwise = adjust_stepwise(t.capture, t.model, disturbed(t));
  ASSERT_TRUE(stepwise);
  EXPECT_LT(largest_difference(RigProblem(t.capture, t.model), t.rig, *stepwise), 1e-6);  // as in CleanData
}

}  // namespace
}  // namespace laterna
