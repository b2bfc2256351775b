#include "calib/code_steps.h"

#include "sim/pattern.h"

#include <gmock/gmock.h>

#include <cmath>

namespace laterna {
namespace {

constexpr glm::ivec2 camera{640, 400}, projector{512, 320};

// What a camera whose pixels are `step` projector pixels apart (turned by a tenth) reads of the columns: bits
// from `first_moved` down come from a place `moved_px(u, v)` away.
template <class Moved>
DecodedMap decoded(double step, int first_moved, const Moved& moved_px) {
  DecodedMap map(camera.x, camera.y);
  const std::uint32_t finer = (1u << (first_moved + 1)) - 1;
  for (int y = 0; y < camera.y; ++y) {
    for (int x = 0; x < camera.x; ++x) {
      const double u = 255.5 + step * (x - 319.5 + 0.1 * (y - 199.5)), v = 159.5 + step * (y - 199.5);
      const double moved = u + moved_px(u, v);
      const auto inside = [](double p, int size) { return p > -0.5 && p < size - 0.5; };
      if (!inside(u, projector.x) || !inside(moved, projector.x) || !inside(v, projector.y)) continue;
      const auto code = [](double p) { return gray_from_binary(std::uint32_t(std::floor(p + 0.5))); };
      const std::size_t i = std::size_t(y) * camera.x + x;
      map.valid.values[i] = 1;
      map.u_px.values[i] = binary_from_gray((code(u) & ~finer) | (code(moved) & finer));
      map.v_px.values[i] = std::floor(v + 0.5);
    }
  }
  return map;
}

TEST(CodeSteps, ACodeOfOnePlaceHasNone) {
  for (const double step : {0.4, 0.5, 0.7, 1.0, 1.25, 1.5, 2.0})
    EXPECT_FALSE(code_steps(decoded(step, -1, [](double, double) { return 0; }), projector)) << step;
}

// Of the two columns on each side of a coarse edge, m are read twice and m never: the asymmetry is m/2 up to
// two columns. Where edges are near, finer ones share in it through the slope: at bit 3, whose next ones are
// 4 columns away, a third of it.
TEST(CodeSteps, AMoveIsSeenWithItsSizeAndBit) {
  for (const double moved : {0.5, 1.0, -1.0, 1.5}) {
    for (const int first_moved : {2, 3, 4}) {
      const auto steps =
          code_steps(decoded(0.7, first_moved, [&](double, double) { return moved; }), projector);
      ASSERT_TRUE(steps) << moved << " px from bit " << first_moved;
      EXPECT_FALSE(steps->rows);
      EXPECT_EQ(steps->bit, first_moved + 1);
      // (1 - 1/3)/2 to 1/2, give or take 0.03: 400 camera pixels around each of many edges
      EXPECT_GT(steps->asymmetry / moved, 0.3);
      EXPECT_LT(steps->asymmetry / moved, 0.53);
    }
  }
}

// A turn about the middle moves the two halves apart, which cancels over the whole image, and not in a
// quadrant.
TEST(CodeSteps, ATurnIsSeenInAQuadrant) {
  const auto turn = [](double, double v) { return 0.01 * (v - 159.5); };
  EXPECT_TRUE(code_steps(decoded(0.7, 3, turn), projector));
}

TEST(CodeSteps, AFewPixelsTellNothing) {
  DecodedMap map = decoded(0.7, 3, [](double, double) { return 1.0; });
  for (std::size_t i = 0; i < map.valid.values.size(); ++i) map.valid.values[i] &= i % 400 == 0;
  EXPECT_FALSE(code_steps(map, projector));
  EXPECT_FALSE(code_steps(DecodedMap(camera.x, camera.y), projector));
}

}  // namespace
}  // namespace laterna
