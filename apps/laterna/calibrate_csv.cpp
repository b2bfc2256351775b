#include "apps/laterna/calibrate_csv.h"

#include "apps/lab/board_report.h"
#include "calib/boards/correspondence_csv.h"
#include "sim/error.h"
#include "sim/safe_write.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

namespace {

glm::ivec2 size_of(const std::string& text, const char* option) {
  if (text.empty())
    throw InputError(fmt::format("{} is missing, expected WIDTHxHEIGHT such as 1280x1024", option));
  const auto size = parse_size(text, option);
  return {size[0], size[1]};
}

// "auto", one word for both devices, or CAMERA,PROJECTOR.
std::vector<std::vector<std::string>> terms_of(const std::string& lens) {
  if (lens == "auto") return {};
  const std::size_t comma = std::min(lens.find(','), lens.size());
  const std::string camera = lens.substr(0, comma);
  const std::string projector = comma < lens.size() ? lens.substr(comma + 1) : camera;
  return {lens_terms(camera), lens_terms(projector)};
}

LadderOptions::Bend bend_of(const CsvWords& words) {
  if (words.bend == "on") return LadderOptions::Bend::on;
  return words.bend == "auto" ? LadderOptions::Bend::climbs : LadderOptions::Bend::off;
}

}  // namespace

void add_csv_words(CLI::App& command, CsvWords& words) {
  command.add_option("--camera-size", words.camera_size, "WIDTHxHEIGHT of the camera, for a FILE.csv");
  command
      .add_option("--lens", words.lens,
                  "For a FILE.csv: auto (the ladder decides), pinhole, k1, k1k2, opencv4, opencv5, opencv8, "
                  "opencv12, terms such as k1+p1p2, or CAMERA,PROJECTOR")
      ->capture_default_str();
  command
      .add_option("--board-bend", words.bend,
                  "For a FILE.csv: on, off, or auto: a term that may climb in with --lens auto")
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "on", "off"}));
  command.add_flag("--one-focal-length", words.one_focal_length, "For a FILE.csv: fx = fy in each device");
  command.add_flag("--fixed-center", words.fixed_center,
                   "For a FILE.csv: the principal point stays in the middle of each image");
  command.add_flag(
      "--compare", words.compare,
      "For a FILE.csv: runs OpenCV's, mrcal's and the stepwise solve on the same sightings with the "
      "same lens model");
}

int calibrate_csv(const std::string& file, const std::string& projector_size, const std::string& out,
                  const CsvWords& words, const std::optional<double>& tolerance_px, const Common& common) {
  BoardOptions options;
  options.terms = terms_of(words.lens);
  options.ladder.bend = bend_of(words);
  options.ladder.one_focal_length = words.one_focal_length;
  options.ladder.fixed_center = words.fixed_center;
  if (tolerance_px) options.tolerance_px = *tolerance_px;
  const BoardCapture capture = read_correspondence_csv(file, size_of(words.camera_size, "--camera-size"),
                                                       size_of(projector_size, "--projector-size"));
  const BoardCalibration calibration = calibrate_boards(capture, options);
  std::vector<MethodResult> methods;
  if (words.compare && calibration.status != Status::refused)
    methods = compare_board_methods(calibration.ladder.fit.capture, calibration.ladder.fit.model);
  nlohmann::json json = board_json(calibration);
  if (words.compare) json["methods"] = methods_json(methods);
  const std::string text = json.dump(2) + "\n";
  if (!out.empty()) write_file(out, text);
  fmt::print("{}", common.json ? text : board_text(calibration));
  if (!methods.empty() && !common.json) fmt::print("\n{}", methods_text(methods));
  if (!out.empty() && !common.json) fmt::print("open {}\n", out);
  if (calibration.status == Status::refused) return exit_refused;
  return calibration.status == Status::weak ? exit_weak : exit_ok;
}

}  // namespace laterna
