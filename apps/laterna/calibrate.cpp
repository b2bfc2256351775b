#include "apps/laterna/calibrate_csv.h"
#include "apps/laterna/pattern_words.h"
#include "apps/laterna/solve_words.h"

#include "apps/lab/calibrate_folder.h"
#include "apps/lab/trial_report.h"
#include "sim/error.h"
#include "sim/safe_write.h"
#include "sim/scene_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

namespace {

struct Words {
  std::string folder, scene, size, out;
  PatternParameters patterns;
  SolveOptions solve;
  CsvWords csv;
};

Scene believed_scene(const Words& words, const CaptureManifest& manifest) {
  if (!words.scene.empty()) return load_scene(words.scene);
  if (manifest.scene.empty())
    throw InputError(fmt::format("{}: names no scene, expected --scene with mesh and camera", words.folder));
  return load_scene(std::filesystem::path(words.folder) / manifest.scene);
}

bool is_table(const std::string& path) {
  return std::filesystem::exists(path) ? !std::filesystem::is_directory(path) : path.ends_with(".csv");
}

int run(const Words& words, const Common& common) {
  const CaptureManifest manifest =
      manifest_or_pictures(words.folder, plain_patterns(words.patterns, words.size));
  const Scene scene = believed_scene(words, manifest);
  SolveOptions options = words.solve;
  options.seed = common.seed;
  const auto estimates = calibrate_folder(words.folder, manifest, scene, options, {},
                                          [&](const std::string& line) { progress(common, line); });
  std::vector<nlohmann::json> entries;
  int code = exit_ok;
  for (const FolderEstimate& e : estimates) {
    entries.push_back(estimate_json(e.projector, e.solve));
    entries.back()["flags"] = e.flags;
    if (e.solve.status == Status::refused) code = exit_refused;
    if (e.solve.status == Status::weak && code == exit_ok) code = exit_weak;
    if (common.json) continue;
    fmt::print("projector \"{}\": {} correspondences\n", e.projector, e.correspondences);
    for (const std::string& flag : e.flags) fmt::print("  pictures {}\n", flag);
    if (e.solve.status != Status::refused) {
      fmt::print("{}  predicted error over the volume {:.4g} px\n", solve_text(e.solve, nullptr),
                 e.solve.predicted_volume_rms_px);
    }
    fmt::print("  verdict: {}{}{}\n", status_word(e.solve.status), e.solve.reason.empty() ? "" : ": ",
               e.solve.reason);
  }
  const std::string text = estimates_text(entries);
  if (!words.out.empty()) write_file(words.out, text);
  if (common.json) fmt::print("{}", text);
  if (!words.out.empty() && !common.json) fmt::print("open {}\n", words.out);
  return code;
}

}  // namespace

void add_calibrate(CLI::App& app, Common& common) {
  auto words = std::make_shared<Words>();
  CLI::App* command =
      add_command(app, "calibrate", "laterna calibrate capture -o estimate.json",
                  "Recovers the projectors of a capture folder from its pictures and a known "
                  "scene: meshes and cameras are believed, nothing of\n"
                  "the projectors but their lens models. Real pictures: --scene with mesh "
                  "and camera, and --projector-size.\n"
                  "From a board in several poses: laterna calibrate board.csv --camera-size "
                  "1280x1024 --projector-size 1024x768, with the columns\n"
                  "pose,corner,board_x,board_y,board_z,cam_x,cam_y,proj_x,proj_y,valid: camera "
                  "and projector together (--tolerance-px is 1 then).");
  command->add_option("FOLDER", words->folder, "Capture folder, folder of pictures, or FILE.csv")->required();
  command->add_option("--scene", words->scene,
                      "Scene with the believed meshes and cameras (default: the folder's own)");
  command->add_option("--projector-size", words->size,
                      "WIDTHxHEIGHT, for a folder without a manifest and for a FILE.csv");
  add_pattern_words(*command, words->patterns);
  command->add_option("-o,--output", words->out, "File for the estimate (JSON; default: none written)");
  add_solve_words(*command, words->solve);
  add_csv_words(*command, words->csv);
  command->callback([words, command, &common] {
    check_output(words->out);
    if (!is_table(words->folder)) {
      for (const char* option :
           {"--camera-size", "--lens", "--board-bend", "--one-focal-length", "--fixed-center", "--compare"})
        if (command->count(option) > 0)
          throw InputError(fmt::format("{}: {} is for a table of correspondences, expected FILE.csv",
                                       words->folder, option));
      common.exit_code = run(*words, common);
      return;
    }
    for (const char* option : {"--scene", "--loss", "--loss-scale"})
      if (command->count(option) > 0)
        throw InputError(fmt::format("{}: {} is for pictures, expected a folder", words->folder, option));
    const bool told = command->count("--tolerance-px") > 0;
    common.exit_code = calibrate_csv(words->folder, words->size, words->out, words->csv,
                                     told ? std::optional(words->solve.tolerance_px) : std::nullopt, common);
  });
}

}  // namespace laterna
