#include "sim/resample.h"

#include <gtest/gtest.h>

namespace laterna {
namespace {

// The upper left corner of the image stays its corner; two pixels become one.
TEST(Resample, KeepsTheCornersAndTheAngles) {
  EXPECT_EQ(resampled_place_px(-0.5, 0.5), -0.5);
  EXPECT_EQ(resampled_place_px(639.5, 0.5), 319.5);
  EXPECT_EQ(resampled_place_px(0.5, 0.5), 0);  // between pixels 0 and 1
  const Intrinsics less = resampled({{641, 400}, 900, 880, 330, 210}, 0.5);
  EXPECT_EQ(less.size, glm::ivec2(320, 200));
  EXPECT_EQ(less.fx, 450);
  EXPECT_EQ(less.fy, 440);
  EXPECT_EQ(less.cx, 164.75);
  EXPECT_EQ(less.cy, 104.75);
  EXPECT_EQ(resampled({{3, 1}, 9, 9, 1, 0}, 0.25).size, glm::ivec2(1, 1));
}

}  // namespace
}  // namespace laterna
