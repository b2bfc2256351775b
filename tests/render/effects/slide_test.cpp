#include "render/effects/slide.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>

namespace laterna {
namespace {

TEST(Slide, EightBitPicturesKeepTheirBitsAndTheirLight) {
  for (const bool is_linear : {true, false}) {
    Slide slide{Image<float>(256, 1), is_linear};
    for (int v = 0; v < 256; ++v) {
      const double e = v / 255.0;
      const double decoded = e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4);
      slide.light(v, 0) = float(is_linear ? e : decoded);
    }
    const PatternStack stack = make_slide_stack({&slide, 1}, {256, 1});
    EXPECT_EQ(stack.count, 1);
    for (int v = 0; v < 256; ++v) {
      EXPECT_EQ(stack.values[v], v);
      EXPECT_NEAR(stack.light_of_value[v], slide.light(v, 0), 1e-7);  // float
    }
    EXPECT_EQ(stack.is_linear(), is_linear);
  }
}

TEST(Slide, OfAnotherSizeIsRefused) {
  const Slide slide{Image<float>(8, 6), true};
  EXPECT_THAT(testing::input_error([&] {
                make_slide_stack({&slide, 1}, {8, 5});
              }),
              ::testing::AllOf(::testing::HasSubstr("8×6"), ::testing::HasSubstr("8×5")));
}

}  // namespace
}  // namespace laterna
