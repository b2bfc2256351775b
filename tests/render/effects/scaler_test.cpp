#include "render/effects/scaler.h"

#include "tests/render/rig.h"
#include "tests/testing.h"

namespace laterna {
namespace {

glm::dvec2 at(const glm::dmat3& h, double u, double v) {
  const glm::dvec3 q = h * glm::dvec3(u, v, 1);
  return glm::dvec2(q) / q.z;
}
void expect_at(const glm::dmat3& h, const glm::dvec2& panel, const glm::dvec2& input) {
  EXPECT_NEAR(glm::distance(at(h, panel.x, panel.y), input), 0, 1e-9)  // rounding of 1e3 px
      << panel.x << ", " << panel.y;
}

TEST(Scaler, AnotherResolutionSpansTheSameRectangle) {
  const glm::dmat3 h = input_from_panel({}, {400, 300}, {800, 900});
  expect_at(h, {-0.5, -0.5}, {-0.5, -0.5});
  expect_at(h, {799.5, 899.5}, {399.5, 299.5});
  expect_at(h, {0.5, 1}, {0, 0});  // the middle of the 2×3 panel pixels that show one
}

TEST(Scaler, OverscanCutsHalfOnEachSide) {
  const glm::dmat3 h = input_from_panel({.overscan = 0.1}, {400, 300}, {400, 300});
  expect_at(h, {-0.5, -0.5}, {19.5, 14.5});
  expect_at(h, {399.5, 299.5}, {379.5, 284.5});
}

// A trapezoid: corners go to corners, and the crossing of its diagonals to the middle. The diagonals from
// (0.2, 0) to (1, 1) and from (0.8, 0) to (0, 1) cross at x = 0.5, y = 0.3/0.8.
TEST(Scaler, KeystoneAgainstTheCrossingOfTheDiagonals) {
  const Scaler scaler{.keystone = {0.2, 0, 0.8, 0, 1, 1, 0, 1}};
  const glm::dmat3 h = input_from_panel(scaler, {400, 300}, {1000, 800});
  const auto panel = [](double a, double b) { return glm::dvec2(a * 1000 - 0.5, b * 800 - 0.5); };
  expect_at(h, panel(0.2, 0), {-0.5, -0.5});
  expect_at(h, panel(0.8, 0), {399.5, -0.5});
  expect_at(h, panel(1, 1), {399.5, 299.5});
  expect_at(h, panel(0, 1), {-0.5, 299.5});
  expect_at(h, panel(0.5, 0.375), {199.5, 149.5});
  EXPECT_GT((h * glm::dvec3(500, 400, 1)).z, 0);
}

PatternStack ramp(int width, int height) {
  PatternStack stack{width, height, 2, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      stack.values.push_back(std::uint8_t(x));
      stack.values.push_back(std::uint8_t(y));
    }
  }
  return stack;
}

TEST(Scaler, ANeutralOneKeepsEveryBit) {
  const PatternStack input = ramp(100, 60);
  for (const Lookup lookup : {Lookup::nearest, Lookup::bilinear}) {
    const PatternStack panel = scale_patterns(input, {.lookup = lookup}, {100, 60});
    EXPECT_EQ(panel.values, input.values);
    EXPECT_EQ(panel.light_of_value, input.light_of_value);
  }
}

// A ramp shows its own coordinates: each panel pixel holds the rounded input coordinate.
TEST(Scaler, PicturesFollowTheCoordinates) {
  const Scaler scaler{.overscan = -0.2, .keystone = {0.1, 0.05, 0.9, 0, 1, 1, 0, 0.9}};
  const PatternStack input = ramp(200, 150);
  const glm::dmat3 h = input_from_panel(scaler, {200, 150}, {320, 240});
  const PatternStack panel = scale_patterns(input, scaler, {320, 240});
  int shown = 0, black = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      const glm::dvec2 q = at(h, x, y);
      if (q.x > 0 && q.x < 199 && q.y > 0 && q.y < 149) {
        ++shown;
        ASSERT_NEAR(panel.texel(x, y)[0], q.x, 0.5 + 1e-9);
        ASSERT_NEAR(panel.texel(x, y)[1], q.y, 0.5 + 1e-9);
      } else if (q.x < -0.6 || q.x > 199.6 || q.y < -0.6 || q.y > 149.6) {
        ++black;
        ASSERT_EQ(panel.texel(x, y)[0] + panel.texel(x, y)[1], 0);
      }
    }
  }
  EXPECT_GT(shown, 20000);
  EXPECT_GT(black, 5000);
}

TEST(Scaler, InputSizeCountsOnlyWhereTheScalerIsOn) {
  Projector projector{testing::device_at({0, 0, 2}, {0, 0, 0}, {100, 80}, 60)};
  projector.effects.scaler.input_size = glm::ivec2(50, 40);
  Effects effects;
  EXPECT_EQ(input_size(effects, projector), glm::ivec2(100, 80));
  effects.scaler = true;
  EXPECT_EQ(input_size(effects, projector), glm::ivec2(50, 40));
}

}  // namespace
}  // namespace laterna
