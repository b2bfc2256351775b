#include "calib/boards/rig_rows.h"

#include "tests/calib/boards/synthetic_boards.h"
#include "tests/testing.h"

#include <ceres/jet.h>
#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <array>

namespace laterna {
namespace {

constexpr int most_columns = 48;
using Jet = ceres::Jet<double, most_columns>;
using Vector3 = std::array<Jet, 3>;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Jet variable(double value, int column) { return column < 0 ? Jet(value) : Jet(value, column); }

// (I + [w]×)·R·x + t: at w = 0 it has the derivative of exp([w]×)·R·x + t.
Vector3 apply_dual(const Rigid& rigid, const Vector3& x, int column) {
  Vector3 r, y;
  for (int i = 0; i < 3; ++i) {
    r[i] = Jet(0.0);
    for (int j = 0; j < 3; ++j) r[i] += rigid.rotation[j][i] * x[j];
  }
  const auto w = [&](int i) { return variable(0, column < 0 ? -1 : column + i); };
  const auto t = [&](int i) { return variable(rigid.translation[i], column < 0 ? -1 : column + 3 + i); };
  y[0] = r[0] + w(1) * r[2] - w(2) * r[1] + t(0);
  y[1] = r[1] + w(2) * r[0] - w(0) * r[2] + t(1);
  y[2] = r[2] + w(0) * r[1] - w(1) * r[0] + t(2);
  return y;
}

// OpenCV's model (its documentation of calib3d), for up to 12 parameters.
std::array<Jet, 2> project_dual(const std::vector<Jet>& k, const Vector3& p) {
  const auto lens = [&](std::size_t i) { return 4 + i < k.size() ? k[4 + i] : Jet(0.0); };
  const Jet x = p[0] / p[2], y = p[1] / p[2], r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
  const Jet radial =
      (1.0 + lens(0) * r2 + lens(1) * r4 + lens(4) * r6) / (1.0 + lens(5) * r2 + lens(6) * r4 + lens(7) * r6);
  const Jet u =
      x * radial + 2.0 * lens(2) * x * y + lens(3) * (r2 + 2.0 * x * x) + lens(8) * r2 + lens(9) * r4;
  const Jet v =
      y * radial + lens(2) * (r2 + 2.0 * y * y) + 2.0 * lens(3) * x * y + lens(10) * r2 + lens(11) * r4;
  return {k[0] * u + k[2], k[1] * v + k[3]};
}

std::array<Jet, 2> predict_dual(const RigProblem& problem, const BoardRig& rig, const Sighting& s) {
  const int skip = problem.pose_columns();
  const auto column = [&](int c) { return c < 0 ? -1 : skip + c; };
  const glm::dvec2 shape = bend_shape(s.x_board, problem.extent);
  Vector3 x = {Jet(s.x_board.x), Jet(s.x_board.y), Jet(s.x_board.z)};
  for (int i = 0; i < 2; ++i)
    x[2] += shape[i] * variable(rig.bend[i], problem.columns.bend < 0 ? -1 : skip + problem.columns.bend + i);
  x = apply_dual(rig.camera_from_board[s.pose], x, skip > 0 ? 0 : -1);
  x = apply_dual(rig.devices[s.device].device_from_camera, x, column(problem.columns.devices[s.device].pose));
  std::vector<Jet> k;
  for (std::size_t i = 0; i < rig.devices[s.device].parameters.size(); ++i)
    k.push_back(variable(rig.devices[s.device].parameters[i],
                         column(problem.columns.devices[s.device].intrinsics[i])));
  return project_dual(k, x);
}

testing::BoardTruth distorted(std::mt19937_64& random, const std::string& camera,
                              const std::string& projector) {
  testing::BoardScene scene;
  scene.poses = 2;
  scene.camera_terms = lens_terms(camera), scene.projector_terms = lens_terms(projector);
  scene.camera_lens = {-0.2, 0.05, 0.001, -0.002, 0.01, 0.02, 0.01, 0.005, 0.001, 0.002, -0.001, 0.002};
  scene.projector_lens = {-0.06, 0.02, 0.015, -0.001, 0.01, -0.01, 0.02, 0.01, 0.001, 0.002, -0.001, 0.002};
  scene.camera_lens.resize(model_of_terms(scene.camera_terms).lens_free.size());
  scene.projector_lens.resize(model_of_terms(scene.projector_terms).lens_free.size());
  scene.bend = {0.002, -0.001};
  testing::BoardTruth t = testing::board_truth(scene, random);
  t.model.bend = true;
  return t;
}

void expect_dual_rows(const testing::BoardTruth& t) {
  const RigProblem problem(t.capture, t.model);
  const int n = problem.row_columns() - 1;
  ASSERT_LE(n, most_columns);
  std::vector<double> rows(2 * std::size_t(n));
  for (const Sighting& s : problem.sightings) {
    double pixel[2];
    ASSERT_TRUE(predict(problem, t.rig, s, pixel, rows.data()));
    const auto dual = predict_dual(problem, t.rig, s);
    for (int r = 0; r < 2; ++r) {
      EXPECT_NEAR(pixel[r], dual[r].a, 1e-9);  // rounding of pixels near 1000
      for (int j = 0; j < n; ++j)              // the 1e-10, relative to the size of a derivative
        ASSERT_NEAR(rows[r * n + j], dual[r].v[j], 1e-10 * std::max(1.0, std::abs(dual[r].v[j]))) << j;
    }
  }
}

TEST(RigRows, DerivativesAreThoseOfDualNumbers) {
  auto random = testing::generator();
  expect_dual_rows(distorted(random, "pinhole", "pinhole"));
  expect_dual_rows(distorted(random, "k1", "opencv4"));
  expect_dual_rows(distorted(random, "opencv5", "opencv8"));
  expect_dual_rows(distorted(random, "opencv12", "k1+p1p2"));
  auto held = distorted(random, "opencv4", "opencv4");
  held.model.hold_poses = true;
  held.model.devices[0].held = true;
  held.model.devices[1].one_focal_length = held.model.devices[1].fixed_center = true;
  expect_dual_rows(held);
}

TEST(RigRows, OneFocalLengthHasOneColumn) {
  auto random = testing::generator();
  auto t = distorted(random, "opencv4", "opencv4");
  t.model.devices[1].one_focal_length = true;
  expect_dual_rows(t);
  EXPECT_EQ(columns_of(t.model).devices[1].intrinsics[0], columns_of(t.model).devices[1].intrinsics[1]);
}

TEST(RigRows, TheFactorHasTheNormalEquationsOfTheRows) {
  auto random = testing::generator();
  auto t = distorted(random, "k1", "k1");
  t.capture = testing::with_noise(t.capture, random);
  for (const auto kind : {RobustLoss::Kind::none, RobustLoss::Kind::huber, RobustLoss::Kind::cauchy}) {
    const RigProblem problem(t.capture, t.model, {kind, 1});
    const int n = problem.row_columns();
    Matrix normal = Matrix::Zero(n, n);
    for (std::size_t i = problem.pose_begin[1]; i < problem.pose_begin[2]; ++i) {
      const Sighting& s = problem.sightings[i];
      double pixel[2];
      Matrix row(2, n - 1), full(2, n);
      ASSERT_TRUE(predict(problem, t.rig, s, pixel, row.data()));
      full << row, Eigen::Vector2d(pixel[0] - s.pixel.x, pixel[1] - s.pixel.y);
      full /= s.sigma_px;
      normal += problem.loss.weight(full.col(n - 1).squaredNorm()) * full.transpose() * full;
    }
    const auto factor = pose_factor(problem, t.rig, 1);
    ASSERT_TRUE(factor);
    const Matrix r = Eigen::Map<const Matrix>(factor->data(), n, n);
    EXPECT_LT((r.transpose() * r - normal).norm(), 1e-12 * normal.norm());  // rounding
  }
}

TEST(RigRows, PointsBehindGiveNoRows) {
  auto random = testing::generator();
  auto t = testing::board_truth({}, random);
  const RigProblem problem(t.capture, t.model);
  t.rig.camera_from_board[0].translation.z = -5;
  EXPECT_FALSE(pose_factor(problem, t.rig, 0));
  EXPECT_FALSE(squared_residuals(problem, t.rig, 0));
  EXPECT_TRUE(pose_factor(problem, t.rig, 1));
}

TEST(RigRows, ModelsThatDoNotFitAreRefused) {
  auto random = testing::generator();
  auto t = testing::board_truth({}, random);
  RigModel model = t.model;
  model.devices.pop_back();
  EXPECT_THAT(testing::input_error([&] { RigProblem(t.capture, model); }),
              ::testing::HasSubstr("1 device models"));
  model = t.model;
  model.devices[0].lens_free = {true};
  EXPECT_THAT(testing::input_error([&] { RigProblem(t.capture, model); }), ::testing::HasSubstr("flags"));
  t.capture.sightings[0].pose = 99;
  EXPECT_THAT(testing::input_error([&] { RigProblem(t.capture, t.model); }), ::testing::HasSubstr("pose 99"));
}

}  // namespace
}  // namespace laterna
