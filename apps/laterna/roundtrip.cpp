#include "apps/laterna/scene_words.h"
#include "apps/laterna/solve_words.h"

#include "apps/lab/roundtrip_folder.h"
#include "apps/lab/trial_report.h"
#include "sim/scene_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

namespace {

struct Words {
  SceneWords scene;
  std::string out;
  TrialOptions options;
};

// NAME-roundtrip, or the first of NAME-roundtrip-2, -3, ... that does not exist yet.
std::string free_folder(const std::string& stem) {
  std::string name = stem + "-roundtrip";
  for (int k = 2; std::filesystem::exists(name); ++k) name = fmt::format("{}-roundtrip-{}", stem, k);
  return name;
}

int run(const Words& words, const Common& common) {
  const Scene scene = load_scene(words.scene.file, words.scene.set);
  const std::string stem = std::filesystem::path(words.scene.file).stem().string();
  std::string target = words.out;
  if (target.empty() && !common.json) target = free_folder(stem);
  TrialOptions options = words.options;
  options.seed = common.seed;
  const RoundtripOutput out =
      roundtrip(scene, stem, target, options, [&](const std::string& line) { progress(common, line); });
  if (common.json) {
    fmt::print("{}\n", trial_json(scene, out.outcomes, out.times).dump());
    return exit_code_of(out.outcomes);
  }
  fmt::print("{}", trial_text(scene, out.outcomes));
  fmt::print("seconds:");
  for (const auto& stage : out.times.stages) fmt::print("  {} {:.2f}", stage.name, stage.seconds);
  fmt::print("\nwritten: ");
  for (const std::string& file : out.files) fmt::print(" {}", file);
  fmt::print("\nopen {}/{}\n", target, out.files.front());
  return exit_code_of(out.outcomes);
}

}  // namespace

void add_roundtrip(CLI::App& app, Common& common) {
  auto words = std::make_shared<Words>();
  CLI::App* command = add_command(app, "roundtrip", "laterna roundtrip scene.toml",
                                  "Casts the patterns, photographs and decodes them, recovers each projector "
                                  "from the pictures, and compares it with the\n"
                                  "true one. Exit code: 0 ok, 2 bad input, 3 refused, 4 weak. With --json "
                                  "and no -o, nothing is written.");
  add_scene_words(*command, words->scene);
  command->add_option("-o,--output", words->out, "New folder for the results (default: SCENE-roundtrip)");
  command->add_flag("--true-uv", words->options.true_uv,
                    "Takes the true projector pixels in place of capture and decoding");
  command->add_flag(
      "--known-intrinsics", words->options.known_intrinsics,
      "Tells the solver the true intrinsics: only the placement is recovered, from flat scenes too");
  add_solve_words(*command, words->options.solve);
  command->callback([words, &common] { common.exit_code = run(*words, common); });
}

}  // namespace laterna
