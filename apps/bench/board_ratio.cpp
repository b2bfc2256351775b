#include "apps/bench/board_ratio.h"

#include "apps/bench/timing.h"
#include "calib/boards/rig_covariance.h"
#include "calib/boards/synthetic_boards.h"
#include "calib/peers/board_methods.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace laterna {

namespace {

synthetic::BoardScene lens_scene(int poses) {
  synthetic::BoardScene scene;
  scene.poses = poses;
  scene.camera_terms = scene.projector_terms = lens_terms("opencv4");
  scene.camera_lens = {-0.2, 0.05, 0.001, -0.001};
  scene.projector_lens = {-0.06, 0.02, 0.002, 0.001};
  return scene;
}

const BoardMethod& method(std::string_view name) {
  for (const BoardMethod& m : board_methods())
    if (m.name == name) return m;
  throw std::runtime_error("no such method");
}

/// A capture with noise, the truth, and what the bound says of the volume.
struct Trial {
  synthetic::BoardTruth truth;
  BoardCapture noisy;
  std::vector<glm::dvec3> places;  ///< x_device of the projector
  std::vector<int> poses;
  double bound_px = 0;

  Trial(int pose_count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    truth = synthetic::board_truth(lens_scene(pose_count), random);
    noisy = synthetic::with_noise(truth.capture, random);
    poses.resize(pose_count);
    std::iota(poses.begin(), poses.end(), 0);
    const auto& k = truth.rig.devices[1].parameters;
    for (int place = 0; place < 20; ++place)
      for (const double range : {1.0, 1.4, 1.8})
        places.push_back(range * glm::dvec3((128.0 + 192 * (place % 5) - k[2]) / k[0],
                                            (96.0 + 192 * (place / 5) - k[3]) / k[1], 1));
    bound_px = bound();
  }

  double error_px(const BoardRig& rig) const {
    const RigProblem problem(truth.capture, truth.model);
    double sum = 0;
    for (const glm::dvec3& x : places) {
      const auto here = carried_pixel(problem.lenses[1], truth.rig, truth.rig, poses, 1, x);
      const auto there = carried_pixel(problem.lenses[1], truth.rig, rig, poses, 1, x);
      if (!here || !there) return std::numeric_limits<double>::infinity();
      sum += glm::dot(*there - *here, *there - *here);
    }
    return std::sqrt(sum / double(places.size()));
  }

 private:
  double bound() const {
    const RigProblem problem(truth.capture, truth.model);
    const auto adjusted = adjust(problem, truth.rig);
    const auto covariance = adjusted ? rig_covariance(problem, *adjusted) : std::nullopt;
    if (!covariance) throw std::runtime_error("the simulated boards do not determine the rig");
    double sum = 0;
    for (const glm::dvec3& x : places) {
      const auto c = pixel_covariance(problem, truth.rig, *covariance, 1, x);
      if (!c) throw std::runtime_error("a place lies behind the projector");
      sum += c->x + c->z;
    }
    return std::sqrt(sum / double(places.size()));
  }
};

}  // namespace

BoardTimes time_boards(int poses, int repeats) {
  const Trial trial(poses, 1);
  const auto time_of = [&](const char* name) {
    return seconds([&] { method(name).solve(trial.noisy, trial.truth.model); });
  };
  std::vector<double> opencv, mrcal, own;
  for (int i = -1; i < repeats; ++i) {  // the first round warms up
    const double joint = time_of("joint");
    const double other = time_of("opencv-stepwise"), third = time_of("mrcal");
    if (i < 0) continue;
    own.push_back(joint), opencv.push_back(other / joint), mrcal.push_back(third / joint);
  }
  const int corners = int(seen_by(trial.noisy, 1).sightings.size());
  return {corners, median(opencv), median(mrcal), median(own)};
}

std::vector<MethodScore> score_board_methods(int rigs) {
  std::vector<MethodScore> scores;
  std::vector<std::vector<double>> ratios(board_methods().size()), errors = ratios, times = ratios;
  for (const BoardMethod& m : board_methods()) scores.push_back({m.name, rigs, 0, 0, 0, 0});
  for (int i = 0; i < rigs; ++i) {
    const Trial trial(8, std::uint64_t(i) + 1);
    for (std::size_t m = 0; m < scores.size(); ++m) {
      double error = std::numeric_limits<double>::infinity();
      times[m].push_back(seconds([&] {
        try {
          error = trial.error_px(board_methods()[m].solve(trial.noisy, trial.truth.model));
        } catch (const Refusal&) {
          ++scores[m].failures;
        }
      }));
      errors[m].push_back(error), ratios[m].push_back(error / trial.bound_px);
    }
  }
  for (std::size_t m = 0; m < scores.size(); ++m) {
    scores[m].over_bound = median(ratios[m]);
    scores[m].error_px = median(errors[m]), scores[m].seconds = median(times[m]);
  }
  return scores;
}

std::string method_scores_text(const std::vector<MethodScore>& scores) {
  std::string text = fmt::format("{:<16} {:>10} {:>10} {:>9} {:>9}\n", "method", "over bound", "error px",
                                 "seconds", "failures");
  for (const MethodScore& s : scores)
    text += fmt::format("{:<16} {:>10.2f} {:>10.4f} {:>9.4f} {:>5}/{}\n", s.name, s.over_bound, s.error_px,
                        s.seconds, s.failures, s.rigs);
  return text;
}

}  // namespace laterna
