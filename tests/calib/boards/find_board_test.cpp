#include "calib/boards/find_board.h"

#include "tests/testing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace laterna {

namespace {

/// A picture of a print that is seen through a homography, with the places of its points.
struct Seen {
  PrintPicture picture;            // the same twice
  std::vector<glm::dvec2> points;  // one per board point
};

// The last point along either axis.
glm::dvec2 far_corner(const PrintedBoard& board) {
  glm::dvec2 last(0.0);
  for (const glm::dvec3& p : board_points(board)) last = glm::max(last, glm::dvec2(p));
  return last;
}

// Board metres to picture pixels: a board of that size across most of 640×480, tilted and turned by `turn`.
glm::dmat3 picture_from_board(const PrintedBoard& board, double turn, double tilt) {
  const glm::dvec2 size = board_size_m(board);
  const double scale = 420 / std::max(size.x, size.y), c = std::cos(turn), s = std::sin(turn);
  const glm::dvec2 middle = far_corner(board) / 2.0;
  const glm::dmat3 centred(1, 0, 0, 0, 1, 0, -middle.x, -middle.y, 1);
  const glm::dmat3 turned(scale * c, scale * s, 0, -scale * s, scale * c, 0, 0, 0, 1);
  const glm::dmat3 perspective(1, 0, tilt / 640, 0, 1 - tilt / 2, tilt / 960, 0, 0, 1);
  const glm::dmat3 moved(1, 0, 0, 0, 1, 0, 321.3, 238.6, 1);
  return moved * perspective * turned * centred;
}

glm::dvec2 divide(const glm::dvec3& p) { return glm::dvec2(p) / p.z; }

float print_at(const Image<float>& print, const glm::dvec2& at) {
  const glm::ivec2 p(glm::floor(at));
  return p.x < 0 || p.y < 0 || p.x >= print.width || p.y >= print.height ? 0.4f : print(p.x, p.y);
}

// 6×6 samples a pixel, light from 0.2 to 0.9 of the scale, and noise of `noise` of the scale.
Seen see(const PrintedBoard& board, const glm::dmat3& h, double noise, std::mt19937_64& random) {
  const Image<float> print = board_print(board);
  const glm::dmat3 board_from_picture = glm::inverse(h);
  const double per_metre = print.width / board_size_m(board).x;
  const glm::dvec2 corner = (board_size_m(board) - far_corner(board)) / 2.0;
  std::normal_distribution<double> normal(0, noise);
  Seen seen{{Image<float>(640, 480), {}}, {}};
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      double sum = 0;
      for (int k = 0; k < 36; ++k) {
        const glm::dvec2 at = glm::dvec2(x, y) + (glm::dvec2(k % 6, k / 6) + 0.5) / 6.0 - 0.5;
        sum += double(print_at(print, (divide(board_from_picture * glm::dvec3(at, 1)) + corner) * per_metre));
      }
      seen.picture.mean(x, y) = float(std::clamp(0.2 + 0.7 * sum / 36 + normal(random), 0.0, 1.0));
    }
  seen.picture.darkest = seen.picture.mean;
  for (const glm::dvec3& p : board_points(board)) seen.points.push_back(divide(h * glm::dvec3(p.x, p.y, 1)));
  return seen;
}

double rms_error(const std::vector<FoundPoint>& found, const std::vector<glm::dvec2>& points) {
  double sum = 0;
  for (const FoundPoint& p : found) {
    const glm::dvec2 d = p.pixel - points[std::size_t(p.index)];
    sum += glm::dot(d, d);
  }
  return found.empty() ? 1e9 : std::sqrt(sum / double(found.size()));
}

// Symmetric boards may be numbered from the other end.
double rms_of_either(std::vector<FoundPoint> found, const std::vector<glm::dvec2>& points, bool symmetric) {
  const double straight = rms_error(found, points);
  if (!symmetric) return straight;
  for (FoundPoint& p : found) p.index = int(points.size()) - 1 - p.index;
  return std::min(straight, rms_error(found, points));
}

}  // namespace

// Turned by any angle, tilted, with noise of 1 % of the scale: the corners' noise is about σ over the edge's
// slope (0.7 of the scale per pixel) over the root of the pixels along an edge in the window, 0.01 px;
// circles' centres are means over hundreds of edge pixels. What is left is the finders' own bias: a tenth of
// a pixel would be poor.
TEST(FindBoard, EveryKindTurnedAndTilted) {
  auto random = testing::generator();
  for (const char* words : {"chessboard,9x6,30mm", "chessboard,8x8,30mm", "charuco,8x6,30mm,22mm,DICT_4X4_50",
                            "circles,7x5,30mm,16mm", "acircles,4x9,20mm,14mm"}) {
    const PrintedBoard board = parse_board(words);
    for (const double turn : {0.1, 1.8, 3.3, -1.3}) {
      const Seen seen = see(board, picture_from_board(board, turn, 0.25), 0.01, random);
      const std::vector<FoundPoint> found = find_board(seen.picture, board);
      ASSERT_EQ(found.size(), seen.points.size()) << words << " turned by " << turn;
      // On a square board without a first corner the rows may be columns: any of four numberings.
      if (board.count.x == board.count.y && is_symmetric(board)) continue;
      EXPECT_LT(rms_of_either(found, seen.points, is_symmetric(board)), 0.15)
          << words << " turned by " << turn;
    }
  }
}

// A circle of a third of the distance, tilted strongly: the centre of its image is off by more than what is
// left.
TEST(FindBoard, CirclesAreTakenFromTheirPerspective) {
  auto random = testing::generator();
  const PrintedBoard board = parse_board("circles,5x4,30mm,20mm");
  const Seen seen = see(board, picture_from_board(board, 0.2, 0.8), 0.0, random);
  const std::vector<FoundPoint> found = find_board(seen.picture, board);
  ASSERT_EQ(found.size(), 20u);
  EXPECT_LT(rms_of_either(found, seen.points, true), 0.1);
}

// Half of the board covered: ChArUco tells the rest, with the right numbers.
TEST(FindBoard, CharucoInPart) {
  auto random = testing::generator();
  const PrintedBoard board = parse_board("charuco,8x6,30mm,22mm");
  Seen seen = see(board, picture_from_board(board, 0.1, 0.2), 0.01, random);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 300; ++x) seen.picture.mean(x, y) = 0.3f;
  const std::vector<FoundPoint> found = find_board(seen.picture, board);
  EXPECT_GT(found.size(), 8u);
  EXPECT_LT(found.size(), seen.points.size());
  EXPECT_LT(rms_error(found, seen.points), 0.15);
}

// A corner of the board is in the dark: what the light's edge touches is left out, the rest is as good as
// before.
TEST(FindBoard, PointsAtTheLightsEdgeAreLeftOut) {
  auto random = testing::generator();
  const PrintedBoard board = parse_board("charuco,9x7,30mm,22mm");
  Seen seen = see(board, picture_from_board(board, 0.05, 0.1), 0.002, random);
  const std::size_t all = find_board(seen.picture, board).size();
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x)
      if (x + y / 5 < 280) seen.picture.mean(x, y) *= 0.15f;
  const std::vector<FoundPoint> found = find_board(seen.picture, board);
  EXPECT_EQ(all, 48u);
  EXPECT_GT(found.size(), 24u);
  EXPECT_LT(found.size(), 48u);
  EXPECT_LT(rms_error(found, seen.points), 0.2);
}

// The light's edge across a chessboard, which OpenCV does not find then; it does by the room's light.
TEST(FindBoard, TheDarkestPictureHelpsOut) {
  auto random = testing::generator();
  const PrintedBoard board = parse_board("chessboard,9x6,30mm");
  Seen seen = see(board, picture_from_board(board, 0.05, 0.1), 0.002, random);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x)
      if (x + y / 5 < 230) seen.picture.mean(x, y) *= 0.15f;
  const std::vector<FoundPoint> found = find_board(seen.picture, board);
  ASSERT_EQ(found.size(), 54u);
  EXPECT_LT(rms_error(found, seen.points), 0.1);
}

TEST(FindBoard, NothingIsFoundInNoiseOrInAnotherBoard) {
  auto random = testing::generator();
  Image<float> noise(320, 240);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (float& value : noise.values) value = uniform(random);
  for (const char* words : {"chessboard,9x6,30mm", "charuco,8x6,30mm,22mm", "circles,7x5,30mm,16mm"})
    EXPECT_TRUE(find_board({noise, noise}, parse_board(words)).empty()) << words;
  const PrintedBoard other = parse_board("chessboard,5x4,30mm");
  const Seen seen = see(other, picture_from_board(other, 0.1, 0.1), 0.01, random);
  EXPECT_TRUE(find_board(seen.picture, parse_board("chessboard,9x6,30mm")).empty());
  EXPECT_TRUE(find_board({}, other).empty());
}

// (1 + 3)/2 and (2 + 2)/2 over the largest sum.
TEST(FindBoard, MeanAndDarkestByHand) {
  ImageStack<std::uint16_t> stack(2, 1, 2);
  stack.picture(0)[0] = 100, stack.picture(1)[0] = 300;
  stack.picture(0)[1] = 0, stack.picture(1)[1] = 100;
  const auto [mean, darkest] = print_picture(CapturedStack(stack));
  EXPECT_FLOAT_EQ(mean.values[0], 1);
  EXPECT_FLOAT_EQ(mean.values[1], 0.25);
  EXPECT_FLOAT_EQ(darkest.values[0], 1);
  EXPECT_FLOAT_EQ(darkest.values[1], 0);
}

}  // namespace laterna
