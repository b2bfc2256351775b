// Many noisy calibrations of one rig, or of many: what sampling says beside what covariances predict.
#pragma once

#include "calib/boards/rig_covariance.h"
#include "tests/calib/boards/synthetic_boards.h"
#include "tests/calib/trials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

namespace laterna::testing {

struct BoardTrials {
  std::vector<std::vector<double>> errors;  ///< global steps from truth to estimate
  std::vector<BoardRig> rigs;
};

/// `count` adjustments of a true rig's sightings under noise.
inline BoardTrials sample_rigs(const BoardTruth& t, int count, std::mt19937_64& random) {
  BoardTrials trials;
  for (int i = 0; i < count; ++i) {
    const auto a = adjust({with_noise(t.capture, random), t.model}, t.rig);
    EXPECT_TRUE(a && a->converged);
    if (!a) continue;
    trials.errors.push_back(global_step(t.rig, a->rig, columns_of(t.model)));
    trials.rigs.push_back(a->rig);
  }
  return trials;
}

/// The covariance at the truth.
inline std::optional<RigCovariance> true_covariance(const BoardTruth& t) {
  const RigProblem problem(t.capture, t.model);
  const auto a = adjust(problem, t.rig);
  return a ? rig_covariance(problem, *a) : std::nullopt;
}

/// Ratios of sampled to predicted standard deviations of each global parameter must lie within `tolerance` of
/// 1, and so must the sampled rms of carried pixels over 5×4 places and three ranges of device 1.
inline void expect_sigmas(const BoardTruth& t, const BoardTrials& trials, double tolerance) {
  const RigProblem problem(t.capture, t.model);
  const auto c = true_covariance(t);
  ASSERT_TRUE(c);
  const auto names = column_names(t.model, t.capture);
  for (int i = 0; i < c->globals; ++i) {
    double sum = 0;
    for (const auto& e : trials.errors) sum += e[i] * e[i];
    const double sampled = std::sqrt(sum / double(trials.errors.size()));
    EXPECT_NEAR(sampled / std::sqrt(c->global[i * c->globals + i]), 1, tolerance) << names[i];
  }
  std::vector<int> poses(t.rig.camera_from_board.size());
  for (std::size_t k = 0; k < poses.size(); ++k) poses[k] = int(k);
  const auto& k = t.rig.devices[1].parameters;
  for (int place = 0; place < 20; ++place) {
    for (const double range : {0.8, 1.5, 30.0}) {
      const glm::dvec2 pixel(128.0 + 192 * (place % 5), 96.0 + 192 * ((place - place % 5) / 5.0));
      const glm::dvec3 x = range * glm::dvec3((pixel.x - k[2]) / k[0], (pixel.y - k[3]) / k[1], 1);
      const auto here = carried_pixel(problem.lenses[1], t.rig, t.rig, poses, 1, x);
      const auto predicted = pixel_covariance(problem, t.rig, *c, 1, x);
      ASSERT_TRUE(here && predicted);
      double sum = 0;
      for (const BoardRig& rig : trials.rigs) {
        const auto there = carried_pixel(problem.lenses[1], t.rig, rig, poses, 1, x);
        ASSERT_TRUE(there);
        sum += glm::dot(*there - *here, *there - *here);
      }
      const double sampled = std::sqrt(sum / double(trials.rigs.size()));
      EXPECT_NEAR(sampled / std::sqrt(predicted->x + predicted->z), 1, tolerance) << place << " " << range;
    }
  }
}

/// eᵀC⁻¹e of the global parameters for one random rig, and how many there are.
struct RigError {
  double squared = 0;
  int parameters = 0;
};
inline std::optional<RigError> random_rig_error(const BoardScene& scene, std::mt19937_64& random) {
  const BoardTruth t = board_truth(scene, random);
  const RigProblem problem(with_noise(t.capture, random), t.model);
  const auto a = adjust(problem, t.rig);
  if (!a || !a->converged) return std::nullopt;
  const auto c = rig_covariance(problem, *a);
  if (!c) return std::nullopt;
  return RigError{mahalanobis(global_step(a->rig, t.rig, problem.columns), c->global), c->globals};
}

/// The 99.7 % quantile of χ² (Wilson and Hilferty 1931; within 0.3 % for 10 or more degrees of freedom).
inline double chi2_997(int degrees) {
  const double v = 2.0 / (9.0 * degrees), z = 2.7478;
  return degrees * std::pow(1 - v + z * std::sqrt(v), 3);
}

}  // namespace laterna::testing
