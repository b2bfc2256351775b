// Capture folders of printed boards to the sightings that a rig is calibrated from: one folder per placement.
#pragma once

#include "apps/lab/simulation.h"
#include "calib/boards/sight_board.h"
#include "calib/decode.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace laterna {

struct BoardFolderOptions {
  std::vector<PrintedBoard> boards;           ///< each is looked for in every folder
  std::optional<PatternSequence> patterns{};  ///< of folders without a manifest
  std::string camera{};                       ///< whose pictures are used; empty: all cameras
  LocalMap local = LocalMap::quadratic;
  DecodeOptions decode{};
};

/// A board that a camera found in a folder.
struct BoardPlacement {
  struct Reading {
    std::string projector;
    BoardReading reading;
  };
  std::string folder, camera;
  int board = 0;                      ///< index into the options' boards
  int pose = 0;                       ///< label in the capture, one for all cameras that found it
  PrintPicture picture;               ///< what it was found in
  std::size_t points = 0;             ///< found by the camera
  std::vector<Reading> projectors{};  ///< what each projector's pixels were like there
};

struct BoardFolders {
  /// Metres; cameras come first, device 0 is the one that found most boards; pose labels count from 0.
  BoardCapture capture;
  std::vector<BoardPlacement> placements;
  std::vector<std::string> warnings;  ///< no board found; what looks wrong in the pictures
  std::vector<std::string> doubts;    ///< of them, those that make the verdict at best weak (decode_report.h)
};

/// The folders themselves, each with its manifest or pictures; in place of one that has neither, its
/// subfolders in the order of their names (numbers compared as numbers). Throws InputError for one that has
/// none of these.
std::vector<std::filesystem::path> placement_folders(const std::vector<std::filesystem::path>& folders);

/// Decodes every folder, looks for every board in the mean of each camera's pictures, and reads the
/// projectors' pixels at its points: where several cameras see a point, as often. Throws InputError where a
/// folder cannot be decoded, devices differ in size between folders, the camera that is named has no
/// pictures, or they are of patterns that light single points only.
BoardFolders read_board_folders(const std::vector<std::filesystem::path>& folders,
                                const BoardFolderOptions& options, const Progress& progress = {});

}  // namespace laterna
