#include "apps/lab/atlas/board_condition.h"
#include "apps/lab/atlas/cell_kinds.h"
#include "apps/lab/noun_json.h"
#include "calib/boards/calibrate_boards.h"
#include "calib/peers/board_methods.h"

#include <fmt/format.h>

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

Graded by_laterna(const BoardProblem& problem, const BoardCondition& c) {
  const BoardCalibration calibration = calibrate_boards(problem.capture, options_of(c));
  Graded graded{Outcome::refused, NAN, NAN, calibration.reason};
  if (calibration.status == Status::refused) return graded;
  const RigFit& fit = calibration.ladder.fit;
  // Poses of the capture that were used; their labels are their indices.
  graded.error_px = board_volume_error_px(problem, fit.model, fit.adjustment.rig, fit.capture.pose_labels);
  graded.predicted_px = std::max(calibration.diagnosis.predicted_volume_rms_px,
                                 calibration.diagnosis.jackknife_volume_rms_px.value_or(0));
  graded.outcome = grade(calibration.status, graded.error_px, graded.predicted_px);
  return graded;
}

Graded by_peer(const BoardProblem& problem, const BoardCondition& c, const std::string& name) {
  RigModel model;
  model.devices.assign(2, model_of_terms(lens_terms(c.lens == "auto" ? "k1k2p1p2" : c.lens)));
  for (const BoardMethod& method : board_methods()) {
    if (method.name != name) continue;
    try {
      const BoardRig rig = method.solve(problem.capture, model);
      std::vector<int> poses(rig.camera_from_board.size());
      std::iota(poses.begin(), poses.end(), 0);
      Graded graded{Outcome::right, board_volume_error_px(problem, model, rig, poses),
                    board_volume_bound_px(problem), ""};
      graded.outcome = grade(Status::ok, graded.error_px, graded.predicted_px);
      return graded;
    } catch (const Refusal& refusal) {
      return {Outcome::refused, NAN, NAN, refusal.what()};
    }
  }
  throw InputError(fmt::format("no method \"{}\" for boards", name));
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
            return CellTrial([condition](const std::string& method, std::uint64_t seed) {
              const BoardProblem problem = board_problem(condition, seed);
              return method == "laterna" ? by_laterna(problem, condition)
                                         : by_peer(problem, condition, method);
            });
          }};
}

}  // namespace laterna
