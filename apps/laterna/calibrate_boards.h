// Boards to a camera and projectors: `laterna calibrate FILE.csv` and `laterna calibrate FOLDER... --board
// BOARD`.
#pragma once

#include "apps/laterna/command.h"

#include "apps/lab/board_folders.h"
#include "calib/boards/calibrate_boards.h"

#include <optional>
#include <string>
#include <vector>

namespace laterna {

/// The command line's own words for boards.
struct BoardWords {
  std::vector<std::string> camera_sizes;
  std::string lens = "auto", bend = "auto";
  bool one_focal_length = false, fixed_center = false, compare = false;
  std::vector<std::string> boards, known;
  std::string camera, local = "quadratic", correspondences, pictures;
};

/// Adds the options of these words.
void add_board_words(CLI::App& command, BoardWords& words);

struct BoardOutput {
  std::string estimate;  ///< file for the JSON; empty: none
  std::optional<double> tolerance_px;
};

/// Calibrates from a table, prints, and writes the JSON. Returns the exit code.
int calibrate_csv(const std::string& file, const std::vector<std::string>& projector_sizes,
                  const BoardWords& words, const BoardOutput& output, const Common& common);

/// The same from capture folders; `patterns` is the family of folders without a manifest.
int calibrate_board_folders(const std::vector<std::string>& folders,
                            const std::optional<PatternSequence>& patterns, const BoardWords& words,
                            const BoardOutput& output, const Common& common);

}  // namespace laterna
