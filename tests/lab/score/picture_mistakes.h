// The usual mistakes of pictures, as they happen in life, to be planted in a capture.
#pragma once

#include "sim/image.h"
#include "sim/pattern_sequence.h"

#include <functional>
#include <random>
#include <string>
#include <vector>

namespace laterna::testing {

/// A mistake and one way to make it.
struct PictureMistake {
  std::string suspect, how;
  /// Draws what the scene then says besides, as KEY=VALUE of sim/scene_file.h: its pictures are taken.
  std::function<std::vector<std::string>(std::mt19937_64& random)> overrides{};
  bool truth_knows = true;  ///< whether the truth's scene says it as well
  /// Changes the pictures that were taken.
  std::function<void(CapturedStack& pictures, const PatternSequence& sequence, std::mt19937_64& random)>
      spoil{};
  bool exchanges_codes = false;  ///< whether the calibrator takes rows for columns, the pictures being right
};

/// A bent response of the projector, or of the camera (whose pictures are gamma-encoded); keystone and
/// overscan that the truth knows of, or does not; a frame lost, shown twice, or exchanged with another; rows
/// shown before columns, or decoded as columns; pictures mirrored or turned by a camera's driver. "right"
/// changes nothing.
std::vector<PictureMistake> picture_mistakes();

}  // namespace laterna::testing
