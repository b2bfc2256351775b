#include "calib/peers/board_methods.h"

#include "calib/boards/rig_start.h"
#include "calib/boards/stepwise.h"
#include "sim/error.h"

#include <array>
#include <chrono>
#include <cmath>

namespace laterna {

namespace {

BoardRig start_of(const BoardCapture& capture, const RigModel& model) {
  const RigStart start = start_rig(capture);
  if (!start.rig) throw Refusal(start.refusal);
  return fitted_to(*start.rig, model, capture);
}

BoardRig solve_joint(const BoardCapture& capture, const RigModel& model) {
  const auto adjusted = adjust({capture, model}, start_of(capture, model));
  if (!adjusted || !adjusted->converged) throw Refusal("the solver does not converge");
  return adjusted->rig;
}

BoardRig solve_stepwise(const BoardCapture& capture, const RigModel& model) {
  const auto rig = adjust_stepwise(capture, model, start_of(capture, model));
  if (!rig) throw Refusal("the solver does not converge");
  return *rig;
}

constexpr std::array<BoardMethod, 5> methods = {{{"joint", solve_joint},
                                                 {"stepwise", solve_stepwise},
                                                 {"opencv-stepwise", solve_opencv_stepwise},
                                                 {"opencv-joint", solve_opencv_joint},
                                                 {"mrcal", solve_mrcal}}};

std::vector<double> fit_rms(const BoardCapture& capture, const RigModel& model, const BoardRig& rig) {
  const RigProblem problem(capture, model);
  std::vector<double> sum(capture.devices.size(), 0.0), count(capture.devices.size(), 0.0);
  for (const Sighting& s : problem.sightings) {
    double pixel[2] = {INFINITY, INFINITY};
    predict(problem, rig, s, pixel, nullptr);
    sum[s.device] += std::pow(pixel[0] - s.pixel.x, 2) + std::pow(pixel[1] - s.pixel.y, 2);
    ++count[s.device];
  }
  for (std::size_t d = 0; d < sum.size(); ++d) sum[d] = std::sqrt(sum[d] / count[d]);
  return sum;
}

MethodResult run(const BoardMethod& method, const BoardCapture& capture, const RigModel& model) {
  MethodResult result;
  result.name = method.name;
  const auto begin = std::chrono::steady_clock::now();
  try {
    result.rig = method.solve(capture, model);
  } catch (const Refusal& refusal) {
    result.failure = refusal.what();
    return result;
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  result.fit_rms_px = fit_rms(capture, model, *result.rig);
  result.held_out =
      hold_out_poses(capture, model, *result.rig,
                     [&](const BoardCapture& others, const BoardRig&) -> std::optional<BoardRig> {
                       try {
                         return method.solve(others, model);
                       } catch (const Refusal&) {
                         return std::nullopt;
                       }
                     });
  return result;
}

}  // namespace

std::span<const BoardMethod> board_methods() { return methods; }

std::vector<MethodResult> compare_board_methods(const BoardCapture& capture, const RigModel& model) {
  std::vector<MethodResult> results;
  for (const BoardMethod& method : methods) results.push_back(run(method, capture, model));
  return results;
}

}  // namespace laterna
