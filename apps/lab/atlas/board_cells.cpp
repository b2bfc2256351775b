#include "apps/lab/atlas/board_condition.h"
#include "apps/lab/atlas/cell_kinds.h"
#include "apps/lab/noun_json.h"
#include "calib/boards/calibrate_boards.h"
#include "calib/peers/board_methods.h"

#include <fmt/format.h>

#include <memory>
#include <numeric>

namespace laterna {

namespace {

BoardOptions options_of(const BoardCondition& c) {
  BoardOptions options;
  if (c.lens != "auto") options.terms.assign(2, lens_terms(c.lens));
  if (c.bend != "auto" && c.bend != "off")
    throw InputError(fmt::format("bend is \"{}\", expected auto or off", c.bend));
  if (c.bend == "off") options.ladder.bend = LadderOptions::Bend::off;
  return options;
}

CellAnswer by_laterna(const BoardProblem& problem, const BoardCondition& c) {
  CellAnswer answer;
  const BoardCalibration calibration =
      answer.times.measure("solve", [&] { return calibrate_boards(problem.capture, options_of(c)); });
  answer.status = calibration.status, answer.reason = calibration.reason;
  if (calibration.status == Status::refused) return answer;
  const RigFit& fit = calibration.ladder.fit;
  // Poses of the capture that were used; their labels are their indices.
  answer.error_px = board_volume_error_px(problem, fit.model, fit.adjustment.rig, fit.capture.pose_labels);
  answer.predicted_px = std::max(calibration.diagnosis.predicted_volume_rms_px,
                                 calibration.diagnosis.jackknife_volume_rms_px.value_or(0));
  return answer;
}

CellAnswer by_peer(const BoardProblem& problem, const BoardCondition& c, const std::string& name) {
  RigModel model;
  model.devices.assign(2, model_of_terms(lens_terms(c.lens == "auto" ? "k1k2p1p2" : c.lens)));
  for (const BoardMethod& method : board_methods()) {
    if (method.name != name) continue;
    CellAnswer answer;
    try {
      const BoardRig rig =
          answer.times.measure("solve", [&] { return method.solve(problem.capture, model); });
      std::vector<int> poses(rig.camera_from_board.size());
      std::iota(poses.begin(), poses.end(), 0);
      answer.error_px = board_volume_error_px(problem, model, rig, poses);
      answer.status = Status::ok;
    } catch (const Refusal& refusal) {
      answer.reason = refusal.what();
    }
    return answer;
  }
  throw InputError(fmt::format("no method \"{}\" for boards", name));
}

CellProblem problem_of(const BoardCondition& c, std::uint64_t seed) {
  const auto problem = std::make_shared<const BoardProblem>(board_problem(c, seed));
  return {[problem, c](const std::string& method) {
            return method == "laterna" ? by_laterna(*problem, c) : by_peer(*problem, c, method);
          },
          [problem] { return board_volume_bound_px(*problem); }};
}

}  // namespace

CellKind board_cells() {
  std::vector<std::string> methods{"laterna"};
  for (const BoardMethod& method : board_methods()) methods.emplace_back(method.name);
  return {"boards", methods,
          [](const nlohmann::json& values, const std::string& place, const std::filesystem::path&) {
            const auto condition = noun_from_json<BoardCondition>(values, place);
            try {
              options_of(condition);
            } catch (const InputError& error) {
              throw InputError(fmt::format("{}: {}", place, error.what()));
            }
            return CellTrial([condition](std::uint64_t seed) { return problem_of(condition, seed); });
          }};
}

}  // namespace laterna
