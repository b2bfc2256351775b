#include "apps/laterna/calibrate_boards.h"

#include "apps/lab/board_json.h"
#include "apps/lab/board_pictures.h"
#include "apps/lab/board_text.h"
#include "apps/lab/known_intrinsics.h"
#include "calib/boards/correspondence_csv.h"
#include "calib/boards/known_devices.h"
#include "calib/boards/sighting_csv.h"
#include "sim/error.h"
#include "sim/safe_write.h"
#include "sim/text_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

namespace {

glm::ivec2 size_of(const std::vector<std::string>& words, const char* option) {
  if (words.empty())
    throw InputError(fmt::format("{} is missing, expected WIDTHxHEIGHT such as 1280x1024", option));
  if (words.size() > 1)
    throw InputError(
        fmt::format("{} stands {} times, expected one WIDTHxHEIGHT such as 1280x1024", option, words.size()));
  const auto size = parse_size(words[0], option);
  return {size[0], size[1]};
}

// NAME=WIDTHxHEIGHT of each device of a table with many, cameras first.
std::vector<BoardDevice> devices_of(const std::vector<std::string>& cameras,
                                    const std::vector<std::string>& projectors) {
  std::vector<BoardDevice> devices;
  for (const auto& [words, option] :
       {std::pair(&cameras, "--camera-size"), std::pair(&projectors, "--projector-size")}) {
    for (const std::string& word : *words) {
      const std::size_t equals = word.find('=');
      if (equals == std::string::npos || equals == 0)
        throw InputError(
            fmt::format("{}: found \"{}\", expected NAME=WIDTHxHEIGHT for a table with the column "
                        "device",
                        option, word));
      const auto size = parse_size(word.substr(equals + 1), option);
      devices.push_back({word.substr(0, equals), {size[0], size[1]}, {}, words == &cameras});
    }
  }
  if (cameras.empty())
    throw InputError("--camera-size is missing, expected NAME=WIDTHxHEIGHT for each camera of the table");
  return devices;
}

BoardCapture read_table(const std::string& file, const std::vector<std::string>& cameras,
                        const std::vector<std::string>& projectors) {
  const std::string text = read_text(file, std::size_t{256} << 20);
  if (is_sighting_csv(text)) return parse_sighting_csv(text, file, devices_of(cameras, projectors));
  return parse_correspondence_csv(text, file, size_of(cameras, "--camera-size"),
                                  size_of(projectors, "--projector-size"));
}

// "auto", one word for all devices, or a word for each, joined by commas.
std::vector<std::vector<std::string>> terms_of(const std::string& lens, std::size_t devices) {
  if (lens == "auto") return {};
  std::vector<std::vector<std::string>> terms;
  for (std::size_t at = 0; at <= lens.size();) {
    const std::size_t comma = std::min(lens.find(',', at), lens.size());
    terms.push_back(lens_terms(lens.substr(at, comma - at)));
    at = comma + 1;
  }
  if (terms.size() != 1 && terms.size() != devices)
    throw InputError(fmt::format("--lens {}: {} words, expected one, or {}, one for each device", lens,
                                 terms.size(), devices));
  terms.resize(devices, terms.back());
  return terms;
}

BoardOptions options_of(const BoardWords& words, const BoardOutput& output, std::size_t devices) {
  BoardOptions options;
  options.terms = terms_of(words.lens, devices);
  options.ladder.bend = words.bend == "on"     ? LadderOptions::Bend::on
                        : words.bend == "auto" ? LadderOptions::Bend::climbs
                                               : LadderOptions::Bend::off;
  options.ladder.one_focal_length = words.one_focal_length;
  options.ladder.fixed_center = words.fixed_center;
  if (output.tolerance_px) options.tolerance_px = *output.tolerance_px;
  return options;
}

void add_known_words(BoardCapture& capture, const BoardWords& words) {
  if (!words.known.empty() && words.compare)
    throw InputError(
        "--compare with --known: the other methods solve for all intrinsics, expected one of the two");
  add_known(capture, read_known_intrinsics(words.known));
  const char* model = words.lens != "auto"     ? "--lens"
                      : words.one_focal_length ? "--one-focal-length"
                      : words.fixed_center     ? "--fixed-center"
                                               : nullptr;
  if (model && all_known(capture))
    throw InputError(fmt::format(
        "{} with --known for every device: no intrinsics are left to solve for, expected one of the two",
        model));
}

int finish(const BoardCalibration& calibration, const BoardFolders& folders, const BoardWords& words,
           const BoardOutput& output, const Common& common) {
  std::vector<MethodResult> methods;
  if (words.compare && calibration.status != Status::refused)
    methods = compare_board_methods(calibration.ladder.fit.capture, calibration.ladder.fit.model);
  nlohmann::json json = board_json(calibration);
  if (words.compare) json["methods"] = methods_json(methods);
  if (!words.boards.empty()) add_placements(json, folders);
  const std::string text = json.dump(2) + "\n";
  if (!output.estimate.empty()) write_file(output.estimate, text);
  if (!words.pictures.empty()) write_board_pictures(words.pictures, folders, calibration);
  fmt::print("{}", common.json ? text : placements_text(folders) + board_text(calibration));
  if (!methods.empty() && !common.json) fmt::print("\n{}", methods_text(methods));
  for (const std::string& written : {output.estimate, words.pictures, words.correspondences})
    if (!written.empty() && !common.json) fmt::print("open {}\n", written);
  if (calibration.status == Status::refused) return exit_refused;
  return calibration.status == Status::weak ? exit_weak : exit_ok;
}

BoardFolderOptions folder_options(const BoardWords& words, const std::optional<PatternSequence>& patterns) {
  BoardFolderOptions options;
  for (const std::string& board : words.boards) options.boards.push_back(parse_board(board));
  if (options.boards.size() > 1 && words.bend == "on")
    throw InputError("--board-bend on: the bend is of one board, expected --board once");
  options.patterns = patterns;
  options.camera = words.camera;
  options.local = words.local == "homography" ? LocalMap::homography : LocalMap::quadratic;
  return options;
}

}  // namespace

void add_board_words(CLI::App& command, BoardWords& words) {
  command
      .add_option(
          "--camera-size", words.camera_sizes,
          "WIDTHxHEIGHT of the camera, for a FILE.csv; NAME=WIDTHxHEIGHT of each for one with the column "
          "device, the first being the rig's frame")
      ->take_all();
  command
      .add_option(
          "--lens", words.lens,
          "For boards: auto (the ladder decides), pinhole, k1, k1k2, opencv4, opencv5, opencv8, "
          "opencv12, terms such as k1+p1p2, splined (or mrcal's name of such a model), or one for each "
          "device: CAMERA,PROJECTOR; a device "
          "of --known keeps its own")
      ->capture_default_str();
  command
      .add_option("--board-bend", words.bend,
                  "For boards: on, off, or auto: a term that may climb in with --lens auto")
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "on", "off"}));
  command.add_flag("--one-focal-length", words.one_focal_length,
                   "For boards: fx = fy in each device but those of --known");
  command.add_flag("--fixed-center", words.fixed_center,
                   "For boards: the principal point stays in the middle of each image but those of --known");
  command.add_flag("--compare", words.compare,
                   "For boards: runs OpenCV's, mrcal's and the stepwise solve on the same sightings with the "
                   "same lens model");
  command.add_option("--board", words.boards,
                     "A printed board that stands elsewhere in every FOLDER; may be given several times: "
                     "chessboard,9x7,75mm (inner corners) or charuco,8x6,40mm,30mm,DICT_4X4_50 (squares) or "
                     "circles,7x5,30mm,15mm or acircles,4x11,20mm,15mm");
  command.add_option(
      "--camera", words.camera,
      "With --board: whose pictures alone are used; all cameras are calibrated jointly without it");
  command
      .add_option(
          "--local-fit", words.local,
          "With --board: how projector pixels run over camera pixels around a point: quadratic or homography")
      ->capture_default_str()
      ->check(CLI::IsMember({"quadratic", "homography"}));
  command.add_option(
      "--correspondences", words.correspondences,
      "With --board: new file for the table of what was found, as `calibrate FILE.csv` reads it");
  command.add_option("--pictures", words.pictures,
                     "For boards: folder for pictures of the points found and of the residuals");
}

int calibrate_csv(const std::string& file, const std::vector<std::string>& projector_sizes,
                  const BoardWords& words, const BoardOutput& output, const Common& common) {
  BoardFolders table;
  table.capture = read_table(file, words.camera_sizes, projector_sizes);
  add_known_words(table.capture, words);
  const BoardOptions options = options_of(words, output, table.capture.devices.size());
  return finish(calibrate_boards(table.capture, options), table, words, output, common);
}

int calibrate_board_folders(const std::vector<std::string>& folders,
                            const std::optional<PatternSequence>& patterns, const BoardWords& words,
                            const BoardOutput& output, const Common& common) {
  BoardFolders found = read_board_folders({folders.begin(), folders.end()}, folder_options(words, patterns),
                                          [&](const std::string& line) { progress(common, line); });
  if (!words.correspondences.empty())
    write_file(words.correspondences, found.capture.devices.size() == 2 ? correspondence_csv(found.capture)
                                                                        : sighting_csv(found.capture));
  add_known_words(found.capture, words);
  BoardOptions options = options_of(words, output, found.capture.devices.size());
  if (words.boards.size() > 1) options.ladder.bend = LadderOptions::Bend::off;
  BoardCalibration calibration = calibrate_boards(found.capture, options);
  add_doubts(calibration, found.doubts);
  return finish(calibration, found, words, output, common);
}

}  // namespace laterna
