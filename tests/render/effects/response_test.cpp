#include "render/effects/response.h"

#include "tests/render/rig.h"
#include "tests/testing.h"

namespace laterna {
namespace {

// 1e-7: the table holds floats, at most 1.
TEST(Response, ARampFollowsThePower) {
  PatternStack stack = testing::constant_pattern({2, 2}, 1, 7);
  apply_response(stack, {.response_exponent = 1.707});
  for (int v = 0; v < 256; ++v) EXPECT_NEAR(stack.light_of_value[v], std::pow(v / 255.0, 1.707), 1e-7);
  EXPECT_EQ(stack.values, testing::constant_pattern({2, 2}, 1, 7).values);
}

TEST(Response, ATableIsLinearBetweenItsPoints) {
  PatternStack stack;
  ProjectorEffects effects;
  effects.response_table = {0.1, 0.2, 0.9, 1.0};
  apply_response(stack, effects);
  EXPECT_NEAR(stack.light_of_value[0], 0.1, 1e-7);
  EXPECT_NEAR(stack.light_of_value[85], 0.2, 1e-7);  // 1/3
  EXPECT_NEAR(stack.light_of_value[255], 1.0, 1e-7);
  EXPECT_NEAR(stack.light_of_value[100], 0.2 + 0.7 * (100.0 / 85 - 1), 1e-6);
}

TEST(Response, BlackIsNotDarkAndWhiteStays) {
  PatternStack stack;
  apply_response(stack, {.response_exponent = 2.0});
  apply_black_level(stack, {.black_level = 1.0 / 2000});
  EXPECT_FLOAT_EQ(stack.light_of_value[0], 1.0f / 2000);
  EXPECT_FLOAT_EQ(stack.light_of_value[255], 1);
  for (int v = 0; v < 256; ++v)
    EXPECT_NEAR(stack.light_of_value[v], 1 / 2000.0 + (1 - 1 / 2000.0) * v * v / 65025.0, 1e-7);
}

TEST(Response, NothingGivenChangesNoBit) {
  PatternStack stack;
  apply_response(stack, {});
  apply_black_level(stack, {});
  EXPECT_TRUE(stack.is_linear());
  apply_response(stack, {.response_exponent = 1.0});
  EXPECT_TRUE(stack.is_linear());
}

}  // namespace
}  // namespace laterna
