// Projector pixels read at the camera's corners: the camera's error is in both.
#include "calib/boards/rig_covariance.h"
#include "calib/boards/synthetic_boards.h"
#include "tests/calib/trials.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <map>

namespace laterna {
namespace {

using synthetic::BoardTruth;

glm::dvec2 pixel_of(const RigProblem& problem, const BoardTruth& truth, Sighting s, int device,
                    const glm::dvec2& step) {
  double pixel[2];
  s.device = device, s.read_at.reset();
  s.x_board += glm::dvec3(step, 0);
  EXPECT_TRUE(predict(problem, truth.rig, s, pixel, nullptr));
  return {pixel[0], pixel[1]};
}

// ∂ pixel / ∂ (x, y of the board), by central differences.
glm::dmat2 by_board(const RigProblem& problem, const BoardTruth& truth, const Sighting& s, int device) {
  constexpr double h = 1e-5;
  const auto column = [&](const glm::dvec2& along) {
    return (pixel_of(problem, truth, s, device, h * along) -
            pixel_of(problem, truth, s, device, -h * along)) /
           (2 * h);
  };
  return {column({1, 0}), column({0, 1})};
}

// Projector pixels that are read at the camera's corners, without errors.
BoardTruth read_truth(int poses, double reading_sigma_px, std::mt19937_64& random) {
  synthetic::BoardScene scene;
  scene.poses = poses, scene.camera_sigma_px = 0.1, scene.projector_sigma_px = reading_sigma_px;
  scene.camera_terms = scene.projector_terms = {"k1"};
  scene.camera_lens = {-0.1, 0, 0, 0}, scene.projector_lens = {-0.05, 0, 0, 0};
  BoardTruth truth = synthetic::board_truth(scene, random);
  const RigProblem problem(truth.capture, truth.model);
  for (Sighting& s : truth.capture.sightings) {
    if (s.device == 0) continue;
    const glm::dmat2 slope = by_board(problem, truth, s, 1) * glm::inverse(by_board(problem, truth, s, 0));
    s.read_at = ReadAt{0, pixel_of(problem, truth, s, 0, {0, 0}), slope};
  }
  return truth;
}

// The camera's error moves what is read there; the reading has an error of its own.
BoardCapture with_read_noise(const BoardTruth& truth, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  BoardCapture noisy = truth.capture;
  std::map<std::pair<int, int>, glm::dvec2> error;
  for (Sighting& s : noisy.sightings) {
    const glm::dvec2 own = s.sigma_px * glm::dvec2(normal(random), normal(random));
    s.pixel += own;
    if (s.device == 0) {
      error[{s.pose, s.corner}] = own;
      continue;
    }
    const glm::dvec2 of_camera = error[{s.pose, s.corner}];
    s.read_at->pixel += of_camera;
    s.pixel += s.read_at->slope * of_camera;
  }
  return noisy;
}

TEST(ReadAt, RowsAreTheDerivatives) {
  auto random = testing::generator();
  const BoardTruth truth = read_truth(2, 0.02, random);
  const RigProblem problem(with_read_noise(truth, random), truth.model);
  const int n = problem.row_columns() - 1, g = problem.columns.count;
  std::vector<double> rows(2 * std::size_t(n));
  std::size_t looked = 0;
  for (const Sighting& s : problem.sightings) {
    if (!s.read_at) continue;
    double pixel[2], up[2], down[2];
    ASSERT_TRUE(predict(problem, truth.rig, s, pixel, rows.data()));
    for (int j = 0; j < g; ++j) {
      std::vector<double> step(g, 0.0);
      const double h = 1e-6;
      step[j] = h;
      ASSERT_TRUE(predict(problem, moved(truth.rig, problem.columns, step, {}), s, up, nullptr));
      step[j] = -h;
      ASSERT_TRUE(predict(problem, moved(truth.rig, problem.columns, step, {}), s, down, nullptr));
      for (int r = 0; r < 2; ++r) {
        const double expected = (up[r] - down[r]) / (2 * h);
        // Central differences: pixels near 1000 round to 1e-13, over 2e-6 that is 1e-7 of a px per unit.
        ASSERT_NEAR(rows[r * n + 6 + j], expected, 1e-6 * std::max(1.0, std::abs(expected))) << j;
      }
    }
    ++looked;
  }
  EXPECT_GT(looked, 50u);
}

// eᵀ·C⁻¹·e over the global parameters, mean of `trials` adjustments of one rig.
double mean_chi2(const BoardTruth& truth, bool tell, int trials, std::mt19937_64& random) {
  double sum = 0;
  for (int k = 0; k < trials; ++k) {
    BoardCapture noisy = with_read_noise(truth, random);
    if (!tell) {
      for (Sighting& s : noisy.sightings) {  // the whole variance, taken for the projector's own
        if (!s.read_at) continue;
        s.sigma_px = std::hypot(s.sigma_px, 0.1 * std::sqrt(std::abs(glm::determinant(s.read_at->slope))));
        s.read_at.reset();
      }
    }
    const RigProblem problem(noisy, truth.model);
    const auto fit = adjust(problem, truth.rig);
    EXPECT_TRUE(fit && fit->converged);
    const auto covariance = fit ? rig_covariance(problem, *fit) : std::nullopt;
    EXPECT_TRUE(covariance);
    if (covariance)
      sum += testing::mahalanobis(global_step(truth.rig, fit->rig, problem.columns), covariance->global);
  }
  return sum / trials;
}

TEST(ReadAt, TheCovarianceIsThatOfSampling) {
  auto random = testing::generator();
  const BoardTruth truth = read_truth(8, 0.02, random);
  const double p = columns_of(truth.model).count;
  constexpr int trials = 100;
  // χ² with p degrees of freedom: the mean of 100 has a standard deviation of sqrt(2p/100).
  EXPECT_NEAR(mean_chi2(truth, true, trials, random), p, 4 * std::sqrt(2 * p / trials));
}

TEST(ReadAt, TakenForIndependentTheCovarianceIsWrong) {
  auto random = testing::generator();
  const BoardTruth truth = read_truth(8, 0.02, random);
  const double p = columns_of(truth.model).count;
  constexpr int trials = 100;
  // Beyond the bound that the right covariance keeps.
  EXPECT_GT(std::abs(mean_chi2(truth, false, trials, random) - p), 4 * std::sqrt(2 * p / trials));
}

}  // namespace
}  // namespace laterna
