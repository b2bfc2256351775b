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
};

Scene believed_scene(const Words& words, const CaptureManifest& manifest) {
  if (!words.scene.empty()) return load_scene(words.scene);
  if (manifest.scene.empty())
    throw InputError(fmt::format("{}: names no scene, expected --scene with mesh and camera", words.folder));
  return load_scene(std::filesystem::path(words.folder) / manifest.scene);
}

int run(const Words& words, const Common& common) {
  if (!words.out.empty()) {
    if (std::filesystem::exists(words.out))
      throw InputError(fmt::format("{} exists already, expected a new file", words.out));
    const auto parent = std::filesystem::absolute(words.out).parent_path();
    if (!std::filesystem::is_directory(parent))
      throw InputError(fmt::format("{}: no such folder, expected one to write into", parent.string()));
  }
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
  CLI::App* command = add_command(app, "calibrate", "laterna calibrate capture -o estimate.json",
                                  "Recovers the projectors of a capture folder from its pictures and a known "
                                  "scene: meshes and cameras are believed, nothing of\n"
                                  "the projectors but their lens models. Real pictures: --scene with mesh "
                                  "and camera, and --projector-size.");
  command->add_option("FOLDER", words->folder, "Capture folder, or a folder of pictures")->required();
  command->add_option("--scene", words->scene,
                      "Scene with the believed meshes and cameras (default: the folder's own)");
  command->add_option("--projector-size", words->size, "WIDTHxHEIGHT, for a folder without a manifest");
  add_pattern_words(*command, words->patterns);
  command->add_option("-o,--output", words->out, "File for the estimate (JSON; default: none written)");
  add_solve_words(*command, words->solve);
  command->callback([words, &common] { common.exit_code = run(*words, common); });
}

}  // namespace laterna
