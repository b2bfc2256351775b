#include "apps/lab/plan/plan.h"

#include "apps/lab/plan/plan_report.h"
#include "apps/lab/runner.h"
#include "apps/laterna/command.h"
#include "apps/laterna/scene_words.h"
#include "sim/error.h"
#include "sim/safe_write.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace laterna {

namespace {

namespace fs = std::filesystem;

struct Words {
  SceneWords scene;
  std::string out, work;
  PlanOptions options;
};

fs::path work_folder_of(const fs::path& out) { return out.parent_path() / (out.stem().string() + "-work"); }

// SCENE-planned.toml beside the scene, or the first of SCENE-planned-2.toml, ... that does not exist yet;
// where a run is resumed, the one whose work was begun.
fs::path default_out(const fs::path& scene, bool resume) {
  fs::path out;
  for (int k = 1;; ++k) {
    const std::string number = k == 1 ? "" : fmt::format("-{}", k);
    out = scene.parent_path() / fmt::format("{}-planned{}.toml", scene.stem().string(), number);
    const bool is_begun = fs::exists(work_folder_of(out));
    if (resume ? is_begun || !fs::exists(out) : !fs::exists(out)) return out;
  }
}

// A refusal leaves no folder that was not there, bad input no empty one.
Plan planned(const Words& words, const PlanOptions& options, const fs::path& work, const Common& common) {
  const bool is_new = !fs::exists(work);
  try {
    return make_plan(words.scene.file, work, options,
                     [&](const std::string& line) { progress(common, line); });
  } catch (const Refusal&) {
    if (is_new) fs::remove_all(work);
    throw;
  } catch (const InputError&) {
    std::error_code not_empty;
    if (is_new) fs::remove(work, not_empty);
    throw;
  }
}

int run(const Words& words, const Common& common) {
  const fs::path out =
      words.out.empty() ? default_out(words.scene.file, words.options.resume) : fs::path(words.out);
  const fs::path work = words.work.empty() ? work_folder_of(out) : fs::path(words.work);
  check_output(out.string());
  const StopSignals signals;  // until the scene is written
  PlanOptions options = words.options;
  options.seed = common.seed, options.set = words.scene.set;
  const Plan plan = planned(words, options, work, common);
  const std::string scene = plan.interrupted ? "" : planned_scene_toml(plan, words.scene.file, out);
  if (plan.interrupted || StopSignals::asked()) {
    fmt::print(stderr, "laterna: interrupted; the same command with --resume goes on\n");
    return exit_interrupted;
  }
  write_file(out, scene);
  if (words.work.empty()) {
    fs::remove_all(work);
  } else {
    write_file(work / "plan.json", plan_json(plan, out.string()).dump(1) + "\n");
    write_file(work / "reference.json", plan_reference(plan).dump(1) + "\n");
  }
  if (common.json)
    fmt::print("{}\n", plan_json(plan, out.string()).dump());
  else
    fmt::print("{}written: {}\n", plan_text(plan), out.string());
  return exit_ok;
}

}  // namespace

void add_plan(CLI::App& app, Common& common) {
  auto words = std::make_shared<Words>();
  CLI::App* command = add_command(
      app, "plan", "laterna plan data/scenes/near_focus.toml --tolerance-px 0.012 -o reduced.toml",
      "No more than the scene needs: finds the effects, samples, resolution, patterns and lens terms that "
      "can "
      "be left out or made\n"
      "cheaper while the calibration answer changes by less than a tolerance, and writes the reduced scene. "
      "Each is tried alone, then\n"
      "all together at low cost, and the result is confirmed at full cost on fresh seeds "
      "(apps/lab/plan/plan.h).\n"
      "Ctrl-C leaves what is done; --resume goes on. Exit code: 0 ok, 2 bad input, 3 the full scene is "
      "refused, "
      "5 interrupted.");
  add_scene_words(*command, words->scene);
  command
      ->add_option("--tolerance-px", words->options.tolerance_px,
                   "By how much the answer may change, rms over the volume, projector pixels")
      ->required();
  command
      ->add_option("--seeds", words->options.seeds,
                   "Of every comparison; four times as many where noise does not let tell")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command->add_option("-o,--output", words->out,
                      "New file for the reduced scene (default: SCENE-planned.toml beside it)");
  command->add_option("--work", words->work,
                      "Folder for the journal, plan.json, and reference.json: what holds on every machine "
                      "(default: a journal beside the reduced scene, until that is written)");
  command->add_flag("--resume", words->options.resume,
                    "Goes on where an interrupted run of the same words stopped");
  command->callback([words, &common] { common.exit_code = run(*words, common); });
}

}  // namespace laterna
