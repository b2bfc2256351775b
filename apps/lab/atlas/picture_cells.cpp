#include "apps/lab/atlas/cell_kinds.h"
#include "apps/lab/noun_json.h"
#include "apps/lab/trial.h"
#include "sim/scene_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace laterna {

namespace {

/// A scene with some keys set to other values; the last projector that fares worst counts.
struct PictureCondition {
  std::string scene;             ///< file, relative to the specification
  std::vector<std::string> set;  ///< overrides as parse_scene() takes them
};

template <class Visitor>
void describe(Visitor& visit, PictureCondition& c) {
  visit(Field{.key = "scene"}, c.scene);
  visit(Field{.key = "set"}, c.set);
}

Graded graded(const ProjectorOutcome& outcome) {
  Graded g{Outcome::refused, NAN, NAN, outcome.solve.reason};
  if (outcome.solve.status == Status::refused) return g;
  g.error_px = outcome.verification.volume.rms;
  g.predicted_px = outcome.solve.predicted_volume_rms_px;
  g.outcome = grade(outcome.solve.status, g.error_px, g.predicted_px);
  if (!outcome.flags.empty())
    g.reason += fmt::format("{}flags: {}", g.reason.empty() ? "" : "; ", fmt::join(outcome.flags, "; "));
  return g;
}

Graded round_trip(const Scene& scene, std::uint64_t seed) {
  StageTimes times;
  TrialOptions options;
  options.seed = options.solve.seed = seed;
  const Traced traced = trace(scene, times);
  Graded worst{Outcome::right, NAN, NAN, ""};
  for (const ProjectorOutcome& outcome : run_trial(scene, traced, options, times)) {
    const Graded g = graded(outcome);
    if (std::isnan(worst.predicted_px) || g.outcome > worst.outcome) worst = g;
  }
  return worst;
}

}  // namespace

CellKind picture_cells() {
  return {"pictures",
          {"laterna"},
          [](const nlohmann::json& values, const std::string& place, const std::filesystem::path& folder) {
            const auto condition = noun_from_json<PictureCondition>(values, place);
            try {
              const auto scene =
                  std::make_shared<const Scene>(load_scene(folder / condition.scene, condition.set));
              return CellTrial(
                  [scene](const std::string&, std::uint64_t seed) { return round_trip(*scene, seed); });
            } catch (const InputError& error) {
              throw InputError(fmt::format("{}: {}", place, error.what()));
            }
          }};
}

}  // namespace laterna
