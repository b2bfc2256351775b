#include "apps/lab/atlas/cell_kinds.h"
#include "apps/lab/atlas/point_condition.h"
#include "apps/lab/noun_json.h"
#include "calib/peers/point_methods.h"
#include "calib/verify.h"

#include <fmt/format.h>

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

Graded solve_one(const PointCondition& c, const std::string& method, std::uint64_t seed) {
  const PointProblem problem = point_problem(c, seed);
  SolveOptions options = options_of(c);
  options.seed = seed;
  const PointAnswer answer =
      solve_points(method, problem.correspondences, problem.truth.intrinsics.size, options);
  Graded graded{Outcome::refused, NAN, NAN, answer.reason};
  if (answer.status == Status::refused) return graded;
  graded.error_px = verify(problem.truth, answer.estimate, {}, problem.lit_points).volume.rms;
  graded.predicted_px = method == "laterna" ? answer.predicted_px : volume_bound_px(problem, c);
  graded.outcome = grade(answer.status, graded.error_px, graded.predicted_px);
  return graded;
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
            return CellTrial([condition](const std::string& method, std::uint64_t seed) {
              return solve_one(condition, method, seed);
            });
          }};
}

}  // namespace laterna
