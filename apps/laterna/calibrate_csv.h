// `laterna calibrate FILE.csv`: a camera and a projector from board correspondences.
#pragma once

#include "apps/laterna/command.h"

#include "calib/boards/calibrate_boards.h"

#include <string>

namespace laterna {

/// The command line's own words for boards.
struct CsvWords {
  std::string camera_size, lens = "auto", bend = "auto";
  bool one_focal_length = false, fixed_center = false, compare = false;
};

/// Adds --camera-size, --lens, --board-bend, --one-focal-length,
/// --fixed-center and --compare.
void add_csv_words(CLI::App& command, CsvWords& words);

/// Calibrates, prints, and writes the JSON to `out` unless that is empty. Returns the exit code.
int calibrate_csv(const std::string& file, const std::string& projector_size, const std::string& out,
                  const CsvWords& words, const std::optional<double>& tolerance_px, const Common& common);

}  // namespace laterna
