#include "sim/printed_board.h"

#include "tests/testing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace laterna {

using testing::input_error;

TEST(PrintedBoard, WordsByHand) {
  const PrintedBoard chessboard = parse_board("chessboard,9x7,75mm");
  EXPECT_EQ(chessboard.kind, BoardKind::chessboard);
  EXPECT_EQ(chessboard.count, glm::ivec2(9, 7));
  EXPECT_DOUBLE_EQ(chessboard.spacing_m, 0.075);
  EXPECT_DOUBLE_EQ(parse_board("chessboard,9x7,1in").spacing_m, 0.0254);
  EXPECT_DOUBLE_EQ(parse_board("circles,7x5,3cm,1.5cm").mark_m, 0.015);
  EXPECT_EQ(parse_board("charuco,8x6,40mm,30mm").dictionary, "DICT_4X4_1000");
}

TEST(PrintedBoard, WordsComeBack) {
  for (const char* words : {"chessboard,9x7,75mm", "charuco,8x6,40mm,30mm,DICT_5X5_100",
                            "circles,7x5,30mm,15mm", "acircles,4x11,20mm,15mm", "chessboard,3x3,0.1m"}) {
    const PrintedBoard board = parse_board(words);
    EXPECT_EQ(parse_board(board_words(board)), board) << words;
  }
}

TEST(PrintedBoard, BadWordsAreNamed) {
  EXPECT_THAT(input_error([] { parse_board("checkers,9x7,75mm"); }),
              ::testing::HasSubstr("\"checkers,9x7,75mm\""));
  EXPECT_THAT(input_error([] { parse_board("chessboard,9x7"); }),
              ::testing::HasSubstr("expected chessboard"));
  EXPECT_THAT(input_error([] { parse_board("chessboard,9by7,75mm"); }), ::testing::HasSubstr("\"9by7\""));
  EXPECT_THAT(input_error([] { parse_board("chessboard,9x7,75"); }), ::testing::HasSubstr("\"75\""));
  EXPECT_THAT(input_error([] { parse_board("chessboard,9x7,-75mm"); }), ::testing::HasSubstr("\"-75mm\""));
  EXPECT_THAT(input_error([] { parse_board("chessboard,9x7,nanmm"); }), ::testing::HasSubstr("\"nanmm\""));
  EXPECT_THAT(input_error([] { parse_board("chessboard,2x7,75mm"); }),
              ::testing::HasSubstr("at least 3 points"));
  EXPECT_THAT(input_error([] { parse_board("circles,7x5,30mm,30mm"); }), ::testing::HasSubstr("do not fit"));
  EXPECT_THAT(input_error([] { parse_board("charuco,8x6,40mm,30mm,DICT_9X9"); }),
              ::testing::HasSubstr("DICT_9X9"));
  EXPECT_THAT(input_error([] { parse_board("charuco,20x20,40mm,30mm,DICT_4X4_50"); }),
              ::testing::HasSubstr("200 markers"));
  EXPECT_THAT(input_error([] { parse_board(""); }), ::testing::HasSubstr("expected chessboard"));
}

TEST(PrintedBoard, PointsByHand) {
  const auto points = board_points(parse_board("chessboard,4x3,10mm"));
  ASSERT_EQ(points.size(), 12u);
  EXPECT_EQ(points[0], glm::dvec3(0.0));
  EXPECT_DOUBLE_EQ(points[5].x, 0.01);  // the second of the second row
  EXPECT_DOUBLE_EQ(points[5].y, 0.01);
  const auto shifted = board_points(parse_board("acircles,4x3,10mm,5mm"));
  EXPECT_DOUBLE_EQ(shifted[4].x, 0.01);  // the second row begins half a distance to the right
  EXPECT_DOUBLE_EQ(shifted[1].x, 0.02);
  EXPECT_EQ(board_points(parse_board("charuco,8x6,40mm,30mm")).size(), 35u);
}

TEST(PrintedBoard, SymmetryByHand) {
  EXPECT_TRUE(is_symmetric(parse_board("chessboard,9x7,75mm")));
  EXPECT_FALSE(is_symmetric(parse_board("chessboard,9x6,75mm")));
  EXPECT_FALSE(is_symmetric(parse_board("charuco,8x6,40mm,30mm")));
  EXPECT_TRUE(is_symmetric(parse_board("circles,7x5,30mm,15mm")));
}

// The print has its first corner where the margin and one square end, black before it and after it.
TEST(PrintedBoard, PrintOfAChessboard) {
  const PrintedBoard board = parse_board("chessboard,4x3,10mm");
  const Image<float> print = board_print(board);
  ASSERT_EQ(print.width, 64 * 7);  // five squares and two margins
  ASSERT_EQ(print.height, 64 * 6);
  EXPECT_EQ(print(10, 10), 1.0f);
  EXPECT_EQ(print(127, 127), 0.0f);
  EXPECT_EQ(print(128, 127), 1.0f);
  EXPECT_EQ(print(127, 128), 1.0f);
  EXPECT_EQ(print(128, 128), 0.0f);
}

// The area that a circle darkens is π·r²: 1 % for edges that are smooth over one pixel.
TEST(PrintedBoard, CirclesHaveTheirArea) {
  const PrintedBoard board = parse_board("circles,4x3,10mm,6mm");
  double dark = 0;
  for (const float value : board_print(board).values) dark += 1 - double(value);
  const double radius_px = 0.3 * 64;
  EXPECT_NEAR(dark / (12 * 3.14159265 * radius_px * radius_px), 1, 0.01);
}

}  // namespace laterna
