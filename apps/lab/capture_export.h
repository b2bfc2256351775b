// Capture folders in the layouts that other people's calibrators read as they are.
//
//   procam    capture_0/graycode_00.png, ...: procam-calibration; columns' bits from the most significant,
//   each with its
//             inverse, then rows' bits, white, black (OpenCV's order, as here). K camera pixels, 8 bits
//   scan3d    set_00/cam_01.png, ...: scan3d-capture; white, black, then columns' and rows' bits;
//   projector_info.txt slstudio  frameSeq_00/frameSeq_00.png, ...: SLStudio's dump of a sequence; the
//   patterns' order, of any family vnl       corners.vnl (# filename x y level) and the pictures it names,
//   CAMERA000.png, PROJECTOR000.png, ...: a
//             printed board's points for mrcal-calibrate-cameras, the projector as one more camera. Pixel
//             centres at whole numbers, points row by row of the board, as there
//
// scan3d-capture centres its code in the next power of two, and has as many bits for rows as for columns.
// Gray codes from column and row 0 are the same code of a projector with 2^n columns and rows, which is what
// projector_info.txt says; where columns and rows differ in bits, the finer axis loses its finest bits and
// counts in pixels of 2, 4, ...
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
