#include "apps/laterna/calibrate_boards.h"
#include "apps/laterna/pattern_words.h"
#include "apps/laterna/solve_words.h"

#include "apps/lab/calibrate_folder.h"
#include "apps/lab/trial_report.h"
#include "sim/error.h"
#include "sim/safe_write.h"
#include "sim/scene_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <utility>

namespace laterna {

namespace {

struct Words {
  std::vector<std::string> paths, sizes;
  std::string scene, out;
  PatternParameters patterns;
  SolveOptions solve;
  BoardWords boards;
};

/// What an option is for: used elsewhere, it is an error.
enum class For { known_scene, boards, table, board_folders };

Scene believed_scene(const Words& words, const CaptureManifest& manifest) {
  if (!words.scene.empty()) return load_scene(words.scene);
  if (manifest.scene.empty())
    throw InputError(
        fmt::format("{}: names no scene, expected --scene with mesh and camera", words.paths[0]));
  return load_scene(std::filesystem::path(words.paths[0]) / manifest.scene);
}

// Of pictures, whose projectors are of one size.
std::string only_size(const std::vector<std::string>& sizes) {
  if (sizes.size() > 1)
    throw InputError(
        fmt::format("--projector-size stands {} times, expected once for pictures", sizes.size()));
  return sizes.empty() ? "" : sizes[0];
}

bool is_table(const std::string& path) {
  return std::filesystem::exists(path) ? !std::filesystem::is_directory(path) : path.ends_with(".csv");
}

int run(const Words& words, const Common& common) {
  if (words.paths.size() > 1)
    throw InputError(
        fmt::format("{} folders, expected one, or --board with a board that stands elsewhere in each",
                    words.paths.size()));
  const std::filesystem::path folder = words.paths[0];
  const CaptureManifest manifest =
      manifest_or_pictures(folder, plain_patterns(words.patterns, only_size(words.sizes)));
  const Scene scene = believed_scene(words, manifest);
  SolveOptions options = words.solve;
  options.seed = common.seed;
  const auto estimates =
      calibrate_folder(folder, manifest, scene, options, {}, read_known_intrinsics(words.boards.known),
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
  const std::string text = estimates_text(entries, scene);
  if (!words.out.empty()) write_file(words.out, text);
  if (common.json) fmt::print("{}", text);
  if (!words.out.empty() && !common.json) fmt::print("open {}\n", words.out);
  return code;
}

void expect_options(const CLI::App& command, For what) {
  static constexpr std::array<std::pair<const char*, For>, 14> options{
      {{"--scene", For::known_scene},
       {"--loss", For::known_scene},
       {"--loss-scale", For::known_scene},
       {"--lens", For::boards},
       {"--board-bend", For::boards},
       {"--one-focal-length", For::boards},
       {"--fixed-center", For::boards},
       {"--compare", For::boards},
       {"--pictures", For::boards},
       {"--camera-size", For::table},
       {"--camera", For::board_folders},
       {"--local-fit", For::board_folders},
       {"--board", For::board_folders},
       {"--correspondences", For::board_folders}}};
  for (const auto& [option, of] : options) {
    if (command.count(option) == 0 || of == what) continue;
    if (of == For::boards && what != For::known_scene) continue;
    const char* right = of == For::known_scene ? "pictures of a known scene, expected a folder and no --board"
                        : of == For::table     ? "a table of correspondences, expected FILE.csv"
                        : of == For::boards    ? "boards, expected FILE.csv or --board"
                                               : "pictures of boards, expected folders and --board";
    throw InputError(fmt::format("{} is for {}", option, right));
  }
}

}  // namespace

void add_calibrate(CLI::App& app, Common& common) {
  auto words = std::make_shared<Words>();
  CLI::App* command = add_command(
      app, "calibrate", "laterna calibrate capture -o estimate.json",
      "Recovers the projectors of a capture folder from its pictures and a known "
      "scene: meshes and cameras are believed, nothing of\n"
      "the projectors but their lens models. Real pictures: --scene with mesh "
      "and camera, and --projector-size.\n"
      "From a board in several places, camera and projectors together (--tolerance-px is 1 then): "
      "laterna calibrate place_* --board chessboard,9x7,75mm,\n"
      "or laterna calibrate board.csv --camera-size 1280x1024 --projector-size 1024x768 with the columns "
      "pose,corner,board_x,board_y,board_z,cam_x,cam_y,proj_x,proj_y,valid;\n"
      "of more devices a line for each sighting, with the columns "
      "device,pose,corner,board_x,board_y,board_z,x,y,sigma_px.");
  command
      ->add_option(
          "FOLDER", words->paths,
          "Capture folder, folder of pictures, FILE.csv; with --board one folder for each place of the "
          "board, or a folder of such folders")
      ->required();
  command->add_option("--scene", words->scene,
                      "Scene with the believed meshes and cameras (default: the folder's own)");
  command
      ->add_option(
          "--projector-size", words->sizes,
          "WIDTHxHEIGHT, for a folder without a manifest and for a FILE.csv; NAME=WIDTHxHEIGHT of each "
          "for one with the column device")
      ->take_all();
  command
      ->add_option(
          "--known", words->boards.known,
          "FILE or NAME=FILE with known intrinsics (.cameramodel, or an estimate with its sigmas): only the "
          "placement is solved for, and a flat scene will do")
      ->take_all();
  add_pattern_words(*command, words->patterns);
  command->add_option("-o,--output", words->out, "File for the estimate (JSON; default: none written)");
  add_solve_words(*command, words->solve);
  add_board_words(*command, words->boards);
  command->callback([words, command, &common] {
    check_output(words->out);
    check_output(words->boards.correspondences);
    const bool table = is_table(words->paths[0]), boards = !words->boards.boards.empty();
    if (table && boards) throw InputError("--board is for pictures, expected folders");
    expect_options(*command, table ? For::table : boards ? For::board_folders : For::known_scene);
    if (!table && !boards) {
      common.exit_code = run(*words, common);
      return;
    }
    const bool told = command->count("--tolerance-px") > 0;
    const BoardOutput output{words->out, told ? std::optional(words->solve.tolerance_px) : std::nullopt};
    common.exit_code = table ? calibrate_csv(words->paths[0], words->sizes, words->boards, output, common)
                             : calibrate_board_folders(
                                   words->paths, plain_patterns(words->patterns, only_size(words->sizes)),
                                   words->boards, output, common);
  });
}

}  // namespace laterna
