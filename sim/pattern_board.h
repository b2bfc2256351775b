// Boards as projected pictures: a chessboard, or one with ArUco markers in its white squares (ChArUco).
//
// The board stands in the middle of the picture, as many whole squares as leave a white margin of at least
// half a square; one column less where columns and rows would be odd or even together, so that a chessboard
// turned by 180° shows.
#pragma once

#include "sim/image.h"
#include "sim/pattern_sequence.h"

#include <glm/glm.hpp>

#include <cstdint>

namespace laterna {

struct BoardLayout {
  glm::ivec2 squares{0, 0};
  glm::ivec2 first_px{0, 0};  ///< the projector pixel in the upper left corner of the board
  int square_px = 0;

  /// The inner corner between squares (i, j) and (i + 1, j + 1), in projector pixels: between pixel centres.
  glm::dvec2 corner_px(int i, int j) const {
    return {first_px.x + (i + 1) * square_px - 0.5, first_px.y + (j + 1) * square_px - 0.5};
  }
};

BoardLayout board_layout(const PatternSequence& sequence);

/// The board, 0 or 255. Markers are of OpenCV's DICT_4X4_1000 and take 3/4 of a square, in OpenCV's order.
Image<std::uint8_t> board_picture(const PatternSequence& sequence);

}  // namespace laterna
