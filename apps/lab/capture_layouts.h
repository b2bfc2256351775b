// Which pictures of a sequence other people's calibrators read, in what order and under which names.
//
//   procam    capture_0/graycode_00.png, ...   procam-calibration: OpenCV's order of Gray codes, as here:
//             columns' bits from the most significant, each with its inverse, then rows' bits, white, black
//   scan3d    set_00/cam_01.png, ...           scan3d-capture: white, black, then the columns' and the
//             rows' bits from the most significant, each with its inverse; projector_info.txt: width height
//   slstudio  frameSeq_00/frameSeq_00.bmp, ... SLStudio's virtual camera, which reads a folder's
//             frameSeq_*.bmp. Gray codes: white, black, then up to 10 bits of columns and 6 of rows, without
//             inverses. Fringes (phase, multi_frequency): as here without white and black, step j showing
//             cos(2πx/pitch - 2πj/N), so that the order of steps 1 to N - 1 is turned round. Other families
//             as they were taken
//
// Pixel centres stand at whole numbers in all of them: column code c is u = c. scan3d-capture centres its
// code in the next power of two, and has as many bits for rows as for columns. Gray codes from column and row
// 0 are the same code of a projector with 2^n columns and rows, which is what projector_info.txt says; where
// columns and rows differ in bits, the finer axis loses its finest bits and counts in pixels of m = 2, 4,
// ...: its c is u = m·c + (m - 1)/2. Sources: calibrate.py of kamino410/procam-calibration;
// src/structured_light.cpp, ProjectorWidget.cpp, CaptureDialog.cpp of scan3d-capture; src/CameraVirtual.cpp,
// src/codec/CodecGrayCode.cpp, CodecCalibration.cpp of jakobwilm/slstudio.
#pragma once

#include "sim/formats/parts.h"
#include "sim/pattern_sequence.h"

#include <string>
#include <vector>

namespace laterna {

struct NamedPicture {
  int index;  ///< into the sequence
  std::string name;
};

/// The pictures of a layout ("procam", "scan3d", "slstudio") in its order; `patterns` are Gray codes but for
/// slstudio. Notes what its reader will not have of the projector's pixels.
std::vector<NamedPicture> layout_pictures(const std::string& layout, const PatternSequence& patterns,
                                          Notes& notes);

/// The folder of place 0, 1, ...
std::string layout_folder(const std::string& layout, std::size_t place);

/// scan3d-capture's projector_info.txt.
std::string projector_info(const PatternSequence& patterns);

}  // namespace laterna
