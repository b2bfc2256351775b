#include "calib/refine.h"

#include "calib/projection_rows.h"
#include "calib/solve.h"
#include "tests/calib/synthetic.h"
#include "tests/testing.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

namespace laterna {
namespace {

struct PointError {
  glm::dvec3 x;
  glm::dvec2 pixel;
  double sigma;
  glm::dmat3 rotation;
  template <class T>
  bool operator()(const T* k, const T* w, const T* t, T* residual) const {
    const glm::dvec3 turned = rotation * x;
    const T rx[3] = {T(turned.x), T(turned.y), T(turned.z)};
    T y[3];
    ceres::AngleAxisRotatePoint(w, rx, y);
    residual[0] = (k[0] * (y[0] + t[0]) / (y[2] + t[2]) + k[2] - pixel.x) / sigma;
    residual[1] = (k[1] * (y[1] + t[1]) / (y[2] + t[2]) + k[3] - pixel.y) / sigma;
    return true;
  }
};

// The same problem with one automatically differentiated block per point, about a state.
struct OneBlockPerPoint {
  double k[4], w[3] = {0, 0, 0}, t[3];
  glm::dmat3 rotation;
  ceres::Problem problem;

  OneBlockPerPoint(const PointTable& points, const ProjectorState& state, const RobustLoss& loss)
      : rotation(state.device_from_points.rotation) {
    std::copy_n(state.parameters.begin(), 4, k);
    for (int i = 0; i < 3; ++i) t[i] = state.device_from_points.translation[i];
    for (std::size_t i = 0; i < points.size(); ++i) {
      auto* error = new PointError{{points.x[i], points.y[i], points.z[i]},
                                   {points.u[i], points.v[i]},
                                   1 / points.inverse_sigma[i],
                                   rotation};
      ceres::LossFunction* function = nullptr;
      if (loss.kind == RobustLoss::Kind::huber) function = new ceres::HuberLoss(loss.scale_sigmas);
      if (loss.kind == RobustLoss::Kind::cauchy) function = new ceres::CauchyLoss(loss.scale_sigmas);
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PointError, 2, 4, 3, 3>(error), function, k, w,
                               t);
    }
  }
};

struct NoisyRig {
  Device truth = testing::usual_projector();
  Correspondences c;
  WorldNormalisation normalisation;
  PointTable points;
  ProjectorState state;
  LensGradient lens{"LENSMODEL_PINHOLE"};

  explicit NoisyRig(std::mt19937_64& random, int n = 700) {
    c = testing::scattered(truth, n, 2, 4, 0.3, random);
    for (std::size_t i = 0; i < c.sigma_px.size(); ++i) c.sigma_px[i] *= 1 + 0.5 * double(i % 3);
    testing::add_noise(c, random);
    testing::add_outliers(c, truth.intrinsics.size, 0.05, random);
    normalisation = normalisation_of(c.world_points);
    points = point_table(c, normalisation);
    state = state_of(truth);
    state.device_from_points = device_from_normalised(truth.device_from_world, normalisation);
    state.parameters[0] *= 1.01;  // somewhere near, not at the minimum
  }
};

const RobustLoss losses[] = {{}, {RobustLoss::Kind::huber, 1.5}, {RobustLoss::Kind::cauchy, 2}};

TEST(ProjectionRows, CostAndGradientEqualOneAutodiffBlockPerPoint) {
  auto random = testing::generator();
  NoisyRig s(random);
  for (const auto& loss : losses) {
    OneBlockPerPoint reference(s.points, s.state, loss);
    double cost = 0;
    std::vector<double> gradient;
    reference.problem.Evaluate({}, &cost, nullptr, &gradient, nullptr);
    const auto r = *row_factor(s.points, s.lens, s.state, loss);
    EXPECT_NEAR(*total_loss(s.points, s.lens, s.state, loss) / (2 * cost), 1, 1e-12);  // sums of 700 terms
    for (int j = 0; j < 10; ++j) {                                                     // g = Rᵀz
      double g = 0, size = 0;
      for (int i = 0; i <= j; ++i) {
        g += r[i * 11 + j] * r[i * 11 + 10];
        size += std::abs(r[i * 11 + j] * r[i * 11 + 10]);
      }
      EXPECT_NEAR(g, gradient[j], 1e-11 * size) << "column " << j;
    }
  }
}

TEST(ProjectionRows, AnswerEqualsOneAutodiffBlockPerPoint) {
  auto random = testing::generator();
  NoisyRig s(random);
  for (const auto& loss : losses) {
    OneBlockPerPoint reference(s.points, s.state, loss);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.function_tolerance = options.gradient_tolerance = 1e-16;
    options.parameter_tolerance = 1e-15;
    options.max_num_iterations = 300;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &reference.problem, &summary);
    const auto own = refine(s.points, s.lens, s.state, {loss, 500, 1280});
    ASSERT_TRUE(own && own->converged) << own->termination;
    EXPECT_NEAR(own->loss / (2 * summary.final_cost), 1, 1e-12);
    const Rigid turn =
        rigid_from_rotation_vector({reference.w[0], reference.w[1], reference.w[2]}, glm::dvec3(0));
    const ProjectorState other{
        {reference.k, reference.k + 4},
        {turn.rotation * reference.rotation, {reference.t[0], reference.t[1], reference.t[2]}}};
    for (std::size_t i = 0; i < s.points.size(); i += 50) {
      double a[2], b[2];
      const glm::dvec3 x(s.points.x[i], s.points.y[i], s.points.z[i]);
      ASSERT_TRUE(project_with_rows(s.lens, own->state, x, a, nullptr));
      ASSERT_TRUE(project_with_rows(s.lens, other, x, b, nullptr));
      // The outliers' cost of 1e6 is rounded by 1e-10: a step of its root, 1e-5 sigmas, is not seen.
      EXPECT_NEAR(a[0], b[0], 2e-5);
      EXPECT_NEAR(a[1], b[1], 2e-5);
    }
  }
}

// Every column of the rows against central differences of the projection.
TEST(ProjectionRows, JacobianEqualsNumericDifferences) {
  auto random = testing::generator();
  for (const char* model : {"LENSMODEL_PINHOLE", "LENSMODEL_OPENCV4", "LENSMODEL_OPENCV5"}) {
    Device d = testing::usual_projector();
    d.lens.model = model;
    d.lens.parameters.resize(lens_parameter_count(model), 0.01);
    Correspondences c = testing::scattered(testing::usual_projector(), 300, 2, 4, 0.5, random);
    testing::add_noise(c, random);
    const PointTable points = point_table(c, {});
    const LensGradient lens(model);
    const ProjectorState state = state_of(d);
    const int k = lens.parameter_count(), p = k + 6;
    const std::size_t n = points.size();
    const auto rows_at = [&](const ProjectorState& at) {
      std::vector<double> rows(2 * n * (p + 1));
      EXPECT_TRUE(fill_rows(points, lens, at, {}, 0, n, {rows.data(), 2 * n, n}));
      return rows;
    };
    const auto rows = rows_at(state);
    for (int j = 0; j < p; ++j) {
      const double h = j < 4 ? 1e-2 : 1e-5;
      const auto moved = [&](double by) {
        ProjectorState at = state;
        glm::dvec3 w(0.0);
        if (j < k) at.parameters[j] += by;
        if (j >= k && j < k + 3) w[j - k] = by;
        if (j >= k + 3) at.device_from_points.translation[j - k - 3] += by;
        at.device_from_points.rotation =
            rigid_from_rotation_vector(w, glm::dvec3(0.0)).rotation * at.device_from_points.rotation;
        return rows_at(at);
      };
      const auto plus = moved(h), minus = moved(-h);
      double size = 0;
      for (std::size_t i = 0; i < 2 * n; ++i) size = std::max(size, std::abs(rows[j * 2 * n + i]));
      for (std::size_t i = 0; i < 2 * n; ++i) {
        const double numeric = (plus[p * 2 * n + i] - minus[p * 2 * n + i]) / (2 * h);
        // Rounding 1e-13·1000 px/h and h² of the step.
        EXPECT_NEAR(numeric, rows[j * 2 * n + i], 1e-6 * size) << model << " column " << j << " row " << i;
      }
    }
  }
}

TEST(ProjectionRows, PointsBehindGiveNone) {
  auto random = testing::generator();
  NoisyRig s(random, 300);
  s.state.device_from_points.translation.z = 0;
  EXPECT_FALSE(row_factor(s.points, s.lens, s.state, {}));
  EXPECT_FALSE(total_loss(s.points, s.lens, s.state, {}));
  EXPECT_FALSE(squared_residuals(s.points, s.lens, s.state));
  EXPECT_FALSE(refine(s.points, s.lens, s.state, {}));
}

TEST(RobustLoss, WeightsAreDerivatives) {
  for (const auto& loss : losses) {
    for (const double s : {0.01, 1.0, 2.0, 5.0, 400.0}) {
      const double h = 1e-5 * s;
      EXPECT_NEAR(loss.weight(s), (loss.rho(s + h) - loss.rho(s - h)) / (2 * h), 1e-8);
      EXPECT_NEAR(loss.weight_slope(s), (loss.weight(s + h) - loss.weight(s - h)) / (2 * h), 1e-8);
      EXPECT_GE(loss.rho(s) - s * loss.weight(s), -1e-15);  // the constant residual is real
    }
  }
}

}  // namespace
}  // namespace laterna
