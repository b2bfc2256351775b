#include "render/effects/spotlight.h"

#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

#include <numbers>

namespace laterna {
namespace {

using testing::facing_plane;
using testing::Lit;

TEST(Spotlight, ConeAndProfile) {
  Scene scene = facing_plane();
  const Lit plain(scene);
  scene.effects.spotlight = true;
  scene.projectors[0].effects.spotlight = {.cutoff_deg = 14.0, .exponent = 3, .intensity = 0.5};
  const Lit lit(scene);
  int dark = 0;
  for (std::size_t p = 0; p < plain.size(); ++p) {
    const glm::dvec3 d = plain.points.values[p] - glm::dvec3(0.2, -0.1, 2);
    const double angle = std::acos(2 / glm::length(d)) * 180 / std::numbers::pi;
    if (angle > 14) {
      ++dark;
      EXPECT_EQ(lit.light().why.values[p], std::uint8_t(Unlit::cutoff));
      EXPECT_EQ(lit.light().white_lx.values[p], 0);
    } else {
      EXPECT_TRUE(lit.light().lit(p));
      EXPECT_NEAR(lit.light().white_lx.values[p],
                  0.5 * std::pow(2 / glm::length(d), 3) * plain.light().white_lx.values[p],
                  1e-9);  // rounding of 450 lx
    }
  }
  EXPECT_GT(dark, 100);
  EXPECT_LT(dark, 2300);
}

}  // namespace
}  // namespace laterna
