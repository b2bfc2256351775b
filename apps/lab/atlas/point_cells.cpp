#include "apps/lab/atlas/cell_kinds.h"
#include "apps/lab/atlas/point_condition.h"
#include "apps/lab/noun_json.h"
#include "calib/peers/point_methods.h"
#include "calib/verify.h"

#include <fmt/format.h>

#include <memory>

namespace laterna {

namespace {

SolveOptions options_of(const PointCondition& c) {
  SolveOptions options;
  if (c.lens == "opencv4")
    options.lens_model = "LENSMODEL_OPENCV4";
  else if (c.lens != "pinhole")
    throw InputError(fmt::format("lens is \"{}\", expected pinhole or opencv4", c.lens));
  if (c.loss == "huber")
    options.loss.kind = RobustLoss::Kind::huber;
  else if (c.loss == "cauchy")
    options.loss.kind = RobustLoss::Kind::cauchy;
  else if (c.loss != "none")
    throw InputError(fmt::format("loss is \"{}\", expected none, huber or cauchy", c.loss));
  return options;
}

CellAnswer solve_one(const PointProblem& problem, const std::string& method, const SolveOptions& options) {
  CellAnswer answer;
  const PointAnswer given = answer.times.measure("solve", [&] {
    return solve_points(method, problem.correspondences, problem.truth.intrinsics.size, options);
  });
  answer.status = given.status, answer.reason = given.reason;
  if (given.status == Status::refused) return answer;
  answer.error_px = verify(problem.truth, given.estimate, {}, problem.lit_points).volume.rms;
  if (method == "laterna") answer.predicted_px = given.predicted_px;
  return answer;
}

CellProblem problem_of(const PointCondition& c, std::uint64_t seed) {
  const auto problem = std::make_shared<const PointProblem>(point_problem(c, seed));
  SolveOptions options = options_of(c);
  options.seed = seed;
  return {[problem, options](const std::string& method) { return solve_one(*problem, method, options); },
          [problem, c] { return volume_bound_px(*problem, c); }};
}

}  // namespace

CellKind point_cells() {
  return {"points", point_method_names(),
          [](const nlohmann::json& values, const std::string& place, const std::filesystem::path&) {
            const auto condition = noun_from_json<PointCondition>(values, place);
            try {
              PointCondition few = condition;
              few.points = 4;
              point_problem(few, 1);
              options_of(condition);
            } catch (const InputError& error) {
              throw InputError(fmt::format("{}: {}", place, error.what()));
            }
            return CellTrial([condition](std::uint64_t seed) { return problem_of(condition, seed); });
          }};
}

}  // namespace laterna
