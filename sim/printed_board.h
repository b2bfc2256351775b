// Printed calibration boards: what stands where on them, and what they look like.
//
// The board's frame has its origin at the first point, x along the first row, y along the first column, z =
// 0; seen from the printed side, with x to the right, y points down. Lengths are in metres.
#pragma once

#include "sim/image.h"

#include <glm/glm.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace laterna {

enum class BoardKind {
  chessboard,         ///< points are the inner corners
  charuco,            ///< the same, with ArUco markers in the white squares
  circles,            ///< points are the centres of dark circles on a square grid
  asymmetric_circles  ///< every other row is shifted by half the distance between circles of a row
};

struct PrintedBoard {
  BoardKind kind = BoardKind::chessboard;
  glm::ivec2 count{0,
                   0};  ///< inner corners of a chessboard, squares of a ChArUco board, circles: columns, rows
  double spacing_m = 0;      ///< side of a square; between circles; of asymmetric ones, between their rows
  double mark_m = 0;         ///< side of a marker, diameter of a circle; 0 on a chessboard
  std::string dictionary{};  ///< of a ChArUco board, by OpenCV's name: DICT_4X4_50, ...
  bool operator==(const PrintedBoard&) const = default;
};

/// A board from words joined by commas, lengths with mm, cm, m or in:
///
///   chessboard,9x7,75mm                 inner corners, square
///   charuco,8x6,40mm,30mm[,DICT_4X4_50] squares, square, marker, dictionary (default DICT_4X4_1000)
///   circles,7x5,30mm,15mm               circles, distance, diameter
///   acircles,4x11,20mm,15mm             OpenCV's asymmetric grid: circles per row, rows, distance between
///   rows
///
/// Throws InputError, naming the word and what was expected, for anything else, for fewer than 3 points in a
/// row or column (2×2 for ChArUco), a mark that does not fit, an unknown dictionary or one of too few
/// markers.
PrintedBoard parse_board(std::string_view text);

/// The words for a board; parse_board(board_words(b)) = b.
std::string board_words(const PrintedBoard& board);

/// Where the points stand, row by row; their index is the corner's number.
std::vector<glm::dvec3> board_points(const PrintedBoard& board);

/// Columns and rows of points: a ChArUco board has one less than squares.
glm::ivec2 point_count(const PrintedBoard& board);

/// OpenCV's number of a dictionary of ArUco markers, cv::aruco::PREDEFINED_DICTIONARY_NAME. Throws InputError
/// for a name that it has not.
int dictionary_id(const std::string& name);

/// Whether the board looks the same turned by 180°, so that its first point is not known.
bool is_symmetric(const PrintedBoard& board);

/// Width and height of the print: all squares, or circles and half a distance around them, and a white margin
/// of one spacing.
glm::dvec2 board_size_m(const PrintedBoard& board);

/// The board's print, 0 black to 1 white, over board_size_m(), x right and y down, its points centred in it.
/// A square has 64 pixels a side (fewer on boards of more than 4096 pixels); edges of circles are smooth.
Image<float> board_print(const PrintedBoard& board);

}  // namespace laterna
