#include "sim/pattern.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::input_error;

TEST(GrayCode, IsTheReflectedCodeByHand) {
  std::vector<std::uint32_t> codes;
  for (std::uint32_t i = 0; i < 8; ++i) codes.push_back(gray_from_binary(i));
  EXPECT_THAT(codes, ElementsAre(0b000, 0b001, 0b011, 0b010, 0b110, 0b111, 0b101, 0b100));
}

TEST(GrayCode, ComesBackAndNeighboursDifferInOneBit) {
  for (std::uint32_t i = 0; i < 20000; ++i) {
    ASSERT_EQ(binary_from_gray(gray_from_binary(i)), i);
    ASSERT_EQ(std::popcount(gray_from_binary(i) ^ gray_from_binary(i + 1)), 1);
  }
  EXPECT_EQ(binary_from_gray(gray_from_binary(0xDEADBEEFu)), 0xDEADBEEFu);
}

TEST(GraySequence, CountsBitsByHand) {
  const std::pair<int, int> expected[] = {{1, 0},     {2, 1},     {3, 2},     {4, 2},
                                          {5, 3},     {768, 10},  {1024, 10}, {1025, 11},
                                          {1280, 11}, {1920, 11}, {16384, 14}};
  for (const auto& [size, bits] : expected) EXPECT_EQ(gray_bits(size), bits) << size;
  EXPECT_EQ(picture_count({{1024, 768}}), 42);
  EXPECT_EQ(picture_count({{1280, 800}}), 44);
  EXPECT_EQ(picture_count({{1, 1}}), 2);
}

TEST(GraySequence, NamesItsPictures) {
  const GraySequence sequence{{1024, 768}};
  EXPECT_EQ(picture_name(sequence, 0), "column bit 9");
  EXPECT_EQ(picture_name(sequence, 1), "column bit 9 inverse");
  EXPECT_EQ(picture_name(sequence, 19), "column bit 0 inverse");
  EXPECT_EQ(picture_name(sequence, 20), "row bit 9");
  EXPECT_EQ(picture_name(sequence, 39), "row bit 0 inverse");
  EXPECT_EQ(picture_name(sequence, 40), "white");
  EXPECT_EQ(picture_name(sequence, 41), "black");
}

TEST(GraySequence, ShowsAFourByTwoProjectorByHand) {
  const GraySequence sequence{{4, 2}};  // columns 00 01 11 10, rows 0 1
  const std::vector<std::vector<int>> expected = {
      {0, 0, 1, 1, 0, 0, 1, 1}, {1, 1, 0, 0, 1, 1, 0, 0}, {0, 1, 1, 0, 0, 1, 1, 0}, {1, 0, 0, 1, 1, 0, 0, 1},
      {0, 0, 0, 0, 1, 1, 1, 1}, {1, 1, 1, 1, 0, 0, 0, 0}, {1, 1, 1, 1, 1, 1, 1, 1}, {0, 0, 0, 0, 0, 0, 0, 0}};
  ASSERT_EQ(picture_count(sequence), int(expected.size()));
  for (int k = 0; k < picture_count(sequence); ++k)
    for (int i = 0; i < 8; ++i) EXPECT_EQ(pattern_picture(sequence, k).values[i], 255 * expected[k][i]) << k;
}

TEST(GraySequence, TellsEachPixelItsPlace) {
  const GraySequence sequence{{37, 21}};
  const int columns = column_bits(sequence), rows = row_bits(sequence);
  for (int y = 0; y < 21; ++y) {
    for (int x = 0; x < 37; ++x) {
      std::uint32_t column = 0, row = 0;
      for (int b = 0; b < columns; ++b) column = 2 * column + gray_bit(sequence, 2 * b, x, y);
      for (int b = 0; b < rows; ++b) row = 2 * row + gray_bit(sequence, 2 * (columns + b), x, y);
      EXPECT_EQ(binary_from_gray(column), std::uint32_t(x));
      EXPECT_EQ(binary_from_gray(row), std::uint32_t(y));
    }
  }
}

TEST(PatternStack, HoldsEveryPictureTexelByTexel) {
  for (const glm::ivec2 size : {glm::ivec2(37, 21), glm::ivec2(1, 5), glm::ivec2(64, 1), glm::ivec2(1, 1)}) {
    const GraySequence sequence{size};
    const PatternStack stack = make_pattern_stack(sequence);
    ASSERT_EQ(stack.values.size(), std::size_t(size.x) * size.y * picture_count(sequence));
    for (int k = 0; k < stack.count; ++k) {
      const Image<std::uint8_t> picture = pattern_picture(sequence, k);
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) ASSERT_EQ(stack.texel(x, y)[k], picture(x, y));
    }
  }
}

TEST(BinaryPatternStack, HoldsEveryBit) {
  for (const glm::ivec2 size : {glm::ivec2(37, 21), glm::ivec2(1, 5), glm::ivec2(64, 1), glm::ivec2(1, 1)}) {
    const GraySequence sequence{size};
    const BinaryPatternStack stack = make_binary_pattern_stack(sequence);
    ASSERT_EQ(stack.count, picture_count(sequence));
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        for (int k = 0; k < stack.count; ++k)
          ASSERT_EQ((stack.code(x, y) >> k) & 1u, std::uint64_t(gray_bit(sequence, k, x, y)));
  }
  EXPECT_EQ(make_binary_pattern_stack({{16384, 16384}}).count, 58);
}

TEST(GraySequence, RefusesAbsurdSizesAndPictures) {
  EXPECT_THAT(input_error([] {
                validate(GraySequence{{0, 5}});
              }),
              HasSubstr("0×5 pixels, expected 1 to 16384"));
  EXPECT_THAT(input_error([] { make_pattern_stack({{16385, 5}}); }), HasSubstr("16385×5"));
  EXPECT_THAT(input_error([] { pattern_picture({{4, -2}}, 0); }), HasSubstr("4×-2"));
  EXPECT_THAT(input_error([] { pattern_picture({{4, 2}}, 8); }), HasSubstr("picture 8, expected 0 to 7"));
  EXPECT_THAT(input_error([] { picture_name({{4, 2}}, -1); }), HasSubstr("picture -1"));
  EXPECT_NO_THROW(validate(GraySequence{{16384, 1}}));
}

}  // namespace
}  // namespace laterna
