#include "sim/pattern_sequence.h"

#include "sim/pattern_board.h"
#include "tests/calib/pictures.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <set>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::input_error;

TEST(PatternSequence, CountsPicturesByHand) {
  const glm::ivec2 size(1280, 800);  // 11 and 10 bits
  const auto count = [&](PatternParameters p) { return picture_count(PatternSequence{p, size}); };
  EXPECT_EQ(count({}), 44);
  EXPECT_EQ(count({.kind = PatternKind::xor_gray}), 44);
  EXPECT_EQ(count({.kind = PatternKind::gray_phase, .steps = 4, .pitch_px = 32}),
            2 * 7 + 4 + 2 * 6 + 4 + 2);  // 80 and 50 stripes of 16 px
  EXPECT_EQ(count({.kind = PatternKind::phase, .steps = 3, .pitch_px = 18}), 4 * 3 + 2);
  EXPECT_EQ(count({.kind = PatternKind::multi_frequency, .steps = 5, .pitches_px = {19, 23, 28}}),
            2 * 3 * 5 + 2);
  EXPECT_EQ(count({.kind = PatternKind::micro_phase, .steps = 3, .pitch_px = 16}), 2 * (3 + 5) + 2);
  EXPECT_EQ(count({.kind = PatternKind::charuco}), 3);
}

TEST(PatternSequence, GrayIsTheGraySequence) {
  const PatternSequence sequence{{}, {37, 21}};
  const GraySequence gray{{37, 21}};
  ASSERT_EQ(picture_count(sequence), picture_count(gray));
  for (int k = 0; k < picture_count(gray); ++k) {
    EXPECT_EQ(pattern_picture(sequence, k).values, pattern_picture(gray, k).values) << k;
    EXPECT_EQ(picture_name(sequence, k), picture_name(gray, k));
  }
}

TEST(PatternSequence, StacksHoldEveryPicture) {
  for (const glm::ivec2 size : {glm::ivec2(70, 41), glm::ivec2(64, 3)}) {
    for (const PatternSequence& sequence : coded_families(size)) {
      const PatternStack stack = make_pattern_stack(sequence);
      ASSERT_EQ(stack.count, picture_count(sequence));
      for (int k = 0; k < stack.count; ++k) {
        const Image<std::uint8_t> picture = pattern_picture(sequence, k);
        for (std::size_t i = 0; i < picture.values.size(); ++i)
          ASSERT_EQ(stack.values[i * stack.count + k], picture.values[i]) << picture_name(sequence, k);
      }
      if (!is_binary(sequence)) continue;
      const BinaryPatternStack bits = make_binary_pattern_stack(sequence);
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
          for (int k = 0; k < stack.count; ++k)
            ASSERT_EQ((bits.code(x, y) >> k & 1u) * 255, stack.texel(x, y)[k]);
    }
  }
}

TEST(PatternSequence, AFringeIsASinusoidByHand) {
  const PatternSequence sequence{{.kind = PatternKind::gray_phase, .steps = 4, .pitch_px = 8}, {8, 1}};
  const int first = pattern_groups(sequence)[1].first;  // two stripes of four pixels: one pair
  EXPECT_EQ(first, 2);
  EXPECT_EQ(pattern_picture(sequence, first).values[0], 255);      // cos 0
  EXPECT_EQ(pattern_picture(sequence, first).values[4], 0);        // cos π
  EXPECT_EQ(pattern_picture(sequence, first + 1).values[2], 0);    // cos(π/2 + π/2)
  EXPECT_EQ(pattern_picture(sequence, first + 2).values[4], 255);  // cos(π + π)
  EXPECT_EQ(picture_name(sequence, first + 1), "column fringe of 8 px, step 2");
}

TEST(PatternSequence, XorStripesStayNarrow) {
  for (const int stripe : {2, 4, 8}) {
    const PatternSequence sequence{{.kind = PatternKind::xor_gray, .xor_stripe_px = stripe}, {512, 4}};
    std::set<std::uint32_t> words;
    for (int x = 0; x < 512; ++x) words.insert(code_word(sequence, 0, x));
    EXPECT_EQ(words.size(), 512u);
    for (int bit = 0; bit < word_code(sequence, 0).bits; ++bit) {
      int run = 1, widest = 1;
      for (int x = 1; x < 512; ++x) {
        const bool same = ((code_word(sequence, 0, x) ^ code_word(sequence, 0, x - 1)) >> bit & 1u) == 0;
        run = same ? run + 1 : 1, widest = std::max(widest, run);
      }
      EXPECT_LE(widest, 2 * stripe) << "bit "
                                    << bit;  // a stripe of the base, and one that a bit's edge joins
    }
  }
}

TEST(PatternSequence, DefaultPitchesTellAllPlacesApart) {
  for (const int size : {480, 768, 1080, 1280, 1920, 3840}) {
    for (const double pitch : {12.0, 16.0, 32.0, 48.0}) {
      EXPECT_GE(least_fringe_distance({.kind = PatternKind::multi_frequency, .pitch_px = pitch}, size), 0.5);
      EXPECT_GE(least_fringe_distance({.kind = PatternKind::micro_phase, .pitch_px = pitch}, size), 0.1);
    }
  }
}

TEST(PatternSequence, BoardsStandInTheMiddle) {
  for (const PatternKind kind : {PatternKind::chessboard, PatternKind::charuco}) {
    const PatternSequence sequence{{.kind = kind, .square_px = 40}, {400, 300}};
    const BoardLayout layout = board_layout(sequence);
    EXPECT_EQ(layout.squares, glm::ivec2(9, 6));  // 9 + 6 is odd
    EXPECT_EQ(layout.first_px, glm::ivec2(20, 30));
    EXPECT_EQ(layout.corner_px(0, 0), glm::dvec2(59.5, 69.5));
    const PatternStack stack = make_pattern_stack(sequence);
    EXPECT_EQ(stack.texel(0, 0)[0], 255);
    EXPECT_EQ(stack.texel(20, 30)[0], 0);  // a black square begins both
    EXPECT_EQ(stack.texel(200, 150)[1], 255);
    EXPECT_EQ(stack.texel(200, 150)[2], 0);
  }
}

TEST(PatternSequence, RefusesWhatCannotBeShown) {
  const auto message = [](PatternParameters p, glm::ivec2 size = {640, 480}) {
    return input_error([&] { validate(PatternSequence{p, size}); });
  };
  using K = PatternKind;
  EXPECT_THAT(message({}, {0, 480}), HasSubstr("0×480"));
  EXPECT_THAT(message({.kind = K::gray_phase, .steps = 2}), HasSubstr("steps is 2, expected 3 to 64"));
  for (const double pitch : {0.0, -5.0, 1.5, 1e9, std::nan("")}) {
    EXPECT_THAT(message({.kind = K::gray_phase, .pitch_px = pitch}), HasSubstr("expected 2 to 100000"))
        << pitch;
    EXPECT_THAT(message({.kind = K::micro_phase, .pitches_px = {16, pitch, 15}}), HasSubstr("a pitch of"));
  }
  EXPECT_THAT(message({.kind = K::multi_frequency, .pitches_px = {16}}),
              HasSubstr("pitches_px has 1 numbers"));
  EXPECT_THAT(message({.kind = K::gray_phase, .pitches_px = {16, 18}}), HasSubstr("pitches_px is given"));
  EXPECT_THAT(message({.kind = K::multi_frequency, .pitches_px = {16, 32}}),
              HasSubstr("repeat within 640 px"));
  EXPECT_THAT(message({.kind = K::micro_phase, .pitches_px = {16, 32, 8}}), HasSubstr("repeat within"));
  EXPECT_THAT(
      message({.kind = K::multi_frequency, .steps = 64, .pitch_px = 2, .pitches_px = {19, 23, 28, 29, 31}}),
      HasSubstr("pictures, expected at most 512"));
  for (const int stripe : {0, 3, -2, 4096})
    EXPECT_THAT(message({.kind = K::xor_gray, .xor_stripe_px = stripe}), HasSubstr("power of two")) << stripe;
  EXPECT_THAT(message({.kind = K::chessboard, .square_px = 300}), HasSubstr("at least 3×3"));
  EXPECT_THAT(message({.kind = K::chessboard, .square_px = 0}), HasSubstr("square_px is 0"));
  EXPECT_THAT(message({.kind = K::charuco, .square_px = 8}), HasSubstr("at most 1000 markers"));
  EXPECT_THAT(input_error([] {
                picture_count(PatternSequence{{.kind = K::slide}, {4, 4}});
              }),
              HasSubstr("files"));
  EXPECT_THAT(input_error([] {
                pattern_picture(PatternSequence{{}, {4, 2}}, 8);
              }),
              HasSubstr("picture 8, expected 0 to 7"));
}

}  // namespace
}  // namespace laterna
