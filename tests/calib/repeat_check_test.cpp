#include "calib/repeat_check.h"

#include "calib/decode.h"
#include "calib/decode_report.h"
#include "tests/calib/pictures.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<PatternSequence> repeating_families() {
  auto families = coded_families({160, 100});
  for (PatternSequence& sequence : families) sequence.parameters.repeat_first = true;
  return families;
}

// The columns' pictures from `place`, the others and the last from `place_after`.
ImageStack<std::uint8_t> moved_halfway(const PatternSequence& sequence, double shift_px,
                                       std::mt19937_64& random) {
  const auto at = [](double shift) {
    return [shift](glm::dvec2 x) { return 0.7 * x + glm::dvec2(8 + shift, 6); };
  };
  ImageStack<std::uint8_t> before = seen(sequence, {180, 110}, 3, at(0), 1, random);
  const ImageStack<std::uint8_t> after = seen(sequence, {180, 110}, 3, at(shift_px), 1, random);
  for (int k = before.count / 2; k < before.count; ++k)
    std::copy_n(after.picture(k).begin(), after.picture_size(), before.picture(k).begin());
  return before;
}

TEST(RepeatCheck, TheLastPictureIsTheFirst) {
  for (const PatternSequence& sequence : repeating_families()) {
    const int last = picture_count(sequence) - 1;
    EXPECT_EQ(white_picture(sequence), last - 2);
    EXPECT_EQ(pattern_picture(sequence, last).values, pattern_picture(sequence, 0).values);
    EXPECT_EQ(picture_name(sequence, last), picture_name(sequence, 0) + " again");
    const PatternStack stack = make_pattern_stack(sequence);
    EXPECT_EQ(stack.texel(100, 50)[last], stack.texel(100, 50)[0]);
    EXPECT_EQ(picture_count(without_repeat(sequence)), last);
  }
}

TEST(RepeatCheck, DecodesAsWithoutIt) {
  auto random = testing::generator();
  for (const PatternSequence& sequence : repeating_families()) {
    const CapturedStack pictures = moved_halfway(sequence, 0, random);
    const DecodedMap with = decode(pictures, sequence);
    const DecodedMap without = decode(without_repeat(pictures, sequence), without_repeat(sequence));
    EXPECT_EQ(with.valid.values, without.valid.values);
    EXPECT_THAT(report_on(pictures, sequence, with).flags, IsEmpty()) << picture_name(sequence, 0);
    EXPECT_EQ(compare_repeat(pictures, sequence)->changed_share, 0);  // beyond 8 sigmas: never
  }
}

TEST(RepeatCheck, AMoveIsADoubt) {
  auto random = testing::generator();
  for (const PatternSequence& sequence : repeating_families()) {
    const CapturedStack pictures = moved_halfway(sequence, 1, random);
    const DecodeReport report = report_on(pictures, sequence, decode(pictures, sequence));
    EXPECT_THAT(report.doubts, Contains(HasSubstr("moved between the first and the last picture")))
        << picture_name(sequence, 0);
  }
}

TEST(RepeatCheck, SaysWhatIsWrong) {
  PatternSequence sequence{{.repeat_first = true}, {160, 100}};
  const ImageStack<std::uint8_t> stack = straight(without_repeat(sequence));
  EXPECT_THAT(testing::input_error([&] { decode(stack, sequence); }),
              HasSubstr("32 pictures, expected 33, the first one again at the end"));
  EXPECT_FALSE(compare_repeat(stack, without_repeat(sequence)));
  sequence.parameters.kind = PatternKind::chessboard;
  EXPECT_THAT(testing::input_error([&] { validate(sequence); }), HasSubstr("coded families only"));
  EXPECT_THAT(testing::input_error([&] {
                validate({{.repeat_first = true}, {1, 100}});
              }),
              HasSubstr("at least 2 px wide"));
}

}  // namespace
}  // namespace laterna
