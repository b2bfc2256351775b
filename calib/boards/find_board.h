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
/// Where the picture shows nothing it is looked at again in the logarithm of its values, in which a print
/// that is partly lit has the same contrast everywhere. Points at whose sides the light changes are left out,
/// since its edge is no part of the print: of the four squares around a corner the white ones must be as
/// bright as each other by three tenths, and the black ones as dark; so must a ring of paper around a circle.
std::vector<FoundPoint> find_board(const Image<float>& picture, const PrintedBoard& board);

/// The mean of a stack, stretched to 0..1: in patterns with inverses, and in fringes of a whole period, the
/// projected light cancels out and what is printed is left.
Image<float> mean_picture(const CapturedStack& stack);

}  // namespace laterna
