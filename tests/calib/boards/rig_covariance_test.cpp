#include "calib/boards/rig_covariance.h"

#include "tests/calib/boards/board_trials.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <Eigen/Dense>

namespace laterna {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

testing::BoardScene usual_scene() {
  testing::BoardScene scene;
  scene.camera_terms = scene.projector_terms = {"k1"};
  scene.camera_lens = {-0.2, 0, 0, 0};
  scene.projector_lens = {-0.06, 0, 0, 0};
  return scene;
}

// All rows at once, no elimination: the inverse of the dense normal matrix.
Matrix dense_covariance(const RigProblem& problem, const BoardRig& rig) {
  const int n = problem.row_columns() - 1, g = problem.columns.count;
  Matrix normal = Matrix::Zero(g + 6 * problem.pose_count(), g + 6 * problem.pose_count());
  for (const Sighting& s : problem.sightings) {
    double pixel[2];
    Matrix row(2, n), wide = Matrix::Zero(2, normal.cols());
    EXPECT_TRUE(predict(problem, rig, s, pixel, row.data()));
    wide.leftCols(g) = row.rightCols(g);
    wide.middleCols(g + 6 * s.pose, 6) = row.leftCols(6);
    normal += wide.transpose() * wide / (s.sigma_px * s.sigma_px);
  }
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  return scale.asDiagonal() * scaled.inverse() * scale.asDiagonal();
}

TEST(RigCovariance, IsTheInverseOfTheDenseNormalMatrix) {
  auto random = testing::generator();
  auto t = testing::board_truth(usual_scene(), random);
  t.model.bend = true;
  const RigProblem problem(t.capture, t.model);
  const auto a = adjust(problem, t.rig);
  ASSERT_TRUE(a);
  const auto c = rig_covariance(problem, *a);
  ASSERT_TRUE(c);
  const auto full = full_covariance(*c);
  const Matrix dense = dense_covariance(problem, a->rig);
  ASSERT_EQ(full.size(), std::size_t(dense.size()));
  for (Eigen::Index i = 0; i < dense.rows(); ++i)
    for (Eigen::Index j = 0; j < dense.cols();
         ++j)  // the normal matrix loses digits: its condition is near 1e9
      ASSERT_NEAR(full[i * dense.cols() + j], dense(i, j), 1e-6 * std::sqrt(dense(i, i) * dense(j, j)));
}

// J·C·Jᵀ of the pixel that `pixel_of` gives of a rig, J by central differences: pixels near 1000 with steps
// of 1e-3 sigma leave some 1e-6.
template <class PixelOf>
Matrix covariance_by_differences(const testing::BoardTruth& t, const RigProblem& problem,
                                 const RigCovariance& c, const PixelOf& pixel_of) {
  const int g = c.globals, n = g + 6 * problem.pose_count();
  const auto full = full_covariance(c);
  Matrix j(2, n);
  for (int i = 0; i < n; ++i) {
    const double h = 1e-3 * std::sqrt(full[i * n + i]);
    glm::dvec2 at[2];
    for (int side = 0; side < 2; ++side) {
      std::vector<double> step(n, 0.0);
      step[i] = side ? h : -h;
      const BoardRig there =
          moved(t.rig, problem.columns, {step.begin(), step.begin() + g}, {step.begin() + g, step.end()});
      at[side] = pixel_of(there);
    }
    j(0, i) = (at[1].x - at[0].x) / (2 * h), j(1, i) = (at[1].y - at[0].y) / (2 * h);
  }
  return j * Eigen::Map<const Matrix>(full.data(), n, n) * j.transpose();
}

void expect_covariance(const std::optional<glm::dvec3>& p, const Matrix& expected) {
  ASSERT_TRUE(p);
  EXPECT_NEAR(p->x / expected(0, 0), 1, 1e-4);
  EXPECT_NEAR(p->z / expected(1, 1), 1, 1e-4);
  EXPECT_NEAR(p->y, expected(0, 1), 1e-4 * expected(0, 0));
}

TEST(RigCovariance, PredictedPixelsAreTheDerivativeOfCarriedOnes) {
  auto random = testing::generator();
  const auto t = testing::board_truth(usual_scene(), random);
  const RigProblem problem(t.capture, t.model);
  const auto c = testing::true_covariance(t);
  ASSERT_TRUE(c);
  const glm::dvec3 x(0.1, -0.3, 1.3);
  std::vector<int> poses;
  for (int k = 0; k < problem.pose_count(); ++k) poses.push_back(k);
  expect_covariance(pixel_covariance(problem, t.rig, *c, 1, x),
                    covariance_by_differences(t, problem, *c, [&](const BoardRig& there) {
                      return *carried_pixel(problem.lenses[1], t.rig, there, poses, 1, x);
                    }));
}

// A point that stays in the camera's frame: boards have no part in it.
TEST(RigCovariance, PixelsOfTheCamerasFrameAreTheDerivativeOfProjectedOnes) {
  auto random = testing::generator();
  const auto t = testing::board_truth(usual_scene(), random);
  const RigProblem problem(t.capture, t.model);
  const auto c = testing::true_covariance(t);
  ASSERT_TRUE(c);
  const glm::dvec3 x(0.1, -0.3, 1.3), x_camera = apply(inverse(t.rig.devices[1].device_from_camera), x);
  expect_covariance(pixel_covariance_in_camera(problem, t.rig, *c, 1, x),
                    covariance_by_differences(t, problem, *c, [&](const BoardRig& there) {
                      double pixel[2];
                      const RigDevice& d = there.devices[1];
                      EXPECT_TRUE(problem.lenses[1].project(
                          d.parameters, apply(d.device_from_camera, x_camera), pixel, nullptr, nullptr));
                      return glm::dvec2(pixel[0], pixel[1]);
                    }));
  EXPECT_FALSE(pixel_covariance_in_camera(problem, t.rig, *c, 1, {0, 0, -1}));
}

TEST(RigCovariance, TwoHundredSolvesAgree) {
  auto random = testing::generator();
  const auto t = testing::board_truth(usual_scene(), random);
  // A sampled sigma of 200 solves scatters by 5 %; 20 % is four times that.
  testing::expect_sigmas(t, testing::sample_rigs(t, 200, random), 0.2);
}

TEST(RigCovariance, RandomRigsLieWithinTheirCovariance) {
  auto random = testing::generator();
  int inside = 0;
  for (int i = 0; i < 50; ++i) {
    const auto e = testing::random_rig_error(usual_scene(), random);
    ASSERT_TRUE(e);
    inside += e->squared < testing::chi2_997(e->parameters);
  }
  EXPECT_GE(inside, 48);  // 0.15 outside expected; three or more: p = 5e-4
}

// Without distortion, which would give away the principal point, one plane leaves intrinsics open.
TEST(RigCovariance, OnePoseDoesNotDetermineAPinhole) {
  auto random = testing::generator();
  const auto t = testing::board_truth({}, random);
  const BoardCapture one = with_poses(t.capture, {0});
  BoardRig rig = t.rig;
  rig.camera_from_board.resize(1);
  const RigProblem problem(one, t.model);
  Adjustment a;
  a.rig = rig;
  a.pose_factors = {*pose_factor(problem, rig, 0)};
  EXPECT_FALSE(rig_covariance(problem, a));
}

}  // namespace
}  // namespace laterna
