// A printed board in a picture: its points, found by OpenCV, to a fraction of a pixel.
#pragma once

#include "sim/image.h"
#include "sim/printed_board.h"

#include <glm/glm.hpp>

#include <vector>

namespace laterna {

struct FoundPoint {
  int index = 0;          ///< into board_points()
  glm::dvec2 pixel{0.0};  ///< integer coordinates at pixel centres
};

/// What a stack of pictures shows of a print, 0 to 1 each, linear.
struct PrintPicture {
  /// Where patterns have inverses, or fringes a whole period, the projected light cancels out.
  Image<float> mean;
  Image<float> darkest;  ///< the least that each pixel was: the print by other light than the projector's
};
PrintPicture print_picture(const CapturedStack& stack);

/// Chessboards by cv::findChessboardCornersSB (Duda and Frese 2018), which needs the whole board, and where
/// that finds nothing by cv::findChessboardCorners and cornerSubPix; ChArUco boards by cv::aruco, any part of
/// them; grids of circles by cv::findCirclesGrid, whole.
///
/// The centre of a circle's image is not the image of its centre: the board's homography H, fitted to the
/// centres, gives each circle's ellipse, the conic H⁻ᵀ·C·H⁻¹, and the difference is taken off (Heikkilä
/// 2000).
///
/// Points are numbered so that rows run to the right as columns run down, never mirrored. Where the board
/// looks the same turned by 180° (is_symmetric()) the first point may be either; the others have one
/// numbering. Empty: no such board, fewer than 4 points.
///
/// Looked at are the mean picture, its logarithm, in which a print that is lit in part has the same contrast
/// everywhere, and the darkest picture, in which the projector's light has no edge; the first in which there
/// is a board counts. Points at whose sides the light changes are left out, since its edge is no part of the
/// print: of the four squares around a corner the white ones must be as bright as each other by three tenths,
/// and the black ones as dark; so must a ring of paper around a circle.
/// Where fewer than half of a chessboard's corners, or of a grid's circles, pass, it was something else.
std::vector<FoundPoint> find_board(const PrintPicture& picture, const PrintedBoard& board);

/// Paints a found board over, with its margin of a square, by what its middle value is: so that another board
/// is not looked for in it.
void cover_board(PrintPicture& picture, const std::vector<FoundPoint>& found);

}  // namespace laterna
