// Capture folders in the layouts that other people's calibrators read as they are.
//
//   procam, scan3d, slstudio   a folder of pictures for each place (capture_layouts.h)
//   vnl                        corners.vnl (# filename x y level) and the pictures it names, CAMERA000.png,
//                              PROJECTOR000.png, ...: a printed board's points for mrcal-calibrate-cameras,
//                              the projector as one more camera. Pixel centres at whole numbers, points row
//                              by row of the board, as there
#pragma once

#include "apps/lab/simulation.h"
#include "sim/formats/parts.h"
#include "sim/printed_board.h"

#include <filesystem>
#include <string>

namespace laterna {

struct CaptureExport {
  std::string layout;             ///< procam, scan3d, slstudio or vnl
  std::string camera, projector;  ///< whose sequence; empty: the only one
  std::string board;              ///< vnl: as parse_board() reads it
};

/// Whether a layout has that name.
bool is_capture_layout(const std::string& name);

/// Leaves a new folder, whole or not at all. `from` is a capture folder, or a folder of several (board
/// places). Throws InputError where a sequence is not Gray codes (procam, scan3d), several cameras or
/// projectors are there and none is named, or vnl finds no board.
void export_capture(const std::filesystem::path& from, const std::filesystem::path& to,
                    const CaptureExport& what, Notes& notes, const Progress& progress = {});

}  // namespace laterna
