#include "apps/laterna/command.h"
#include "apps/laterna/scene_words.h"

#include "apps/lab/capture_writer.h"
#include "apps/lab/explain.h"
#include "sim/scene_build.h"
#include "sim/scene_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

namespace {

void print_effects(const std::vector<EffectCost>& costs, bool json) {
  if (json) {
    fmt::print("{}\n", explain_json(costs));
    return;
  }
  fmt::print("{}", explain_text(costs));
}

}  // namespace

void add_capture(CLI::App& app, Common& common) {
  struct Words {
    SceneWords scene;
    std::string out;
    CaptureOptions options;
    bool explain = false;
    int board_places = 0;
  };
  auto words = std::make_shared<Words>();
  CLI::App* command = add_command(app, "capture", "laterna capture scene.toml -o capture",
                                  "Plays each projector's patterns and writes every camera's pictures, the "
                                  "scene, the matrices and the truth per\n"
                                  "pixel into a new folder with a manifest (sim/capture_folder.h).");
  add_scene_words(*command, words->scene);
  command->add_option("-o,--output", words->out, "New folder (none is needed with --explain)");
  command
      ->add_option(
          "--format", words->options.format,
          "Picture format: png, tif (fastest, uncompressed), pgm (8 bits), exr, or tif-pages (one file "
          "per sequence)")
      ->capture_default_str();
  command->add_flag("!--no-truth", words->options.truth, "Leaves out the truth per pixel");
  command->add_flag("--explain", words->explain,
                    "Toggles each effect in turn and prints what it costs and changes, in place of a folder");
  command
      ->add_option("--board-places", words->board_places,
                   "Captures the scene so many times into OUTPUT/place_00, place_01, ..., its first mesh "
                   "with `board` held "
                   "at another place each time, for `laterna calibrate OUTPUT --board ...`")
      ->check(CLI::Range(1, 1000));
  command->callback([words, &common] {
    if (words->out.empty() && !words->explain) throw CLI::RequiredError("--output");
    const SceneSpec spec = with_names(read_scene_spec(words->scene.file, words->scene.set));
    const Scene scene = load_scene(words->scene.file, words->scene.set);
    words->options.seed = common.seed;
    const std::filesystem::path folder = std::filesystem::path(words->scene.file).parent_path();
    if (words->explain) {
      print_effects(explain_effects(spec, scene, folder, common.seed,
                                    [&](const std::string& line) { progress(common, line); }),
                    common.json);
      return;
    }
    StageTimes times;
    const Progress tell = [&](const std::string& line) { progress(common, line); };
    const std::vector<std::string> warnings =
        words->board_places > 0
            ? write_board_captures(spec, folder, words->out, words->board_places, words->options, times, tell)
            : write_capture(spec, scene, folder, words->out, words->options, times, tell);
    if (common.json) {
      nlohmann::json seconds;
      for (const auto& stage : times.stages) seconds[stage.name] = stage.seconds;
      fmt::print("{}\n",
                 nlohmann::json{{"folder", words->out}, {"seconds", seconds}, {"warnings", warnings}}.dump());
      return;
    }
    for (const auto& stage : times.stages) fmt::print("  {:<10} {:>8.3f} s\n", stage.name, stage.seconds);
    fmt::print("open {}/{}\n", words->out,
               words->board_places > 0 ? "place_00/manifest.json" : "manifest.json");
  });
}

}  // namespace laterna
