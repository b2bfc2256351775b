#include "calib/orientation.h"

#include <gmock/gmock.h>

#include <cmath>

namespace laterna {
namespace {

// A map with (u, v) = J·(x, y), rounded or not.
DecodedMap affine_map(double ux, double uy, double vx, double vy, bool rounded) {
  DecodedMap map(80, 60);
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 80; ++x) {
      const double u = 500 + ux * x + uy * y, v = 500 + vx * x + vy * y;
      map.u_px(x, y) = rounded ? std::round(u) : u;
      map.v_px(x, y) = rounded ? std::round(v) : v;
      map.valid(x, y) = 1;
    }
  }
  return map;
}

std::string words(double ux, double uy, double vx, double vy) {
  const std::string rounded = orientation_words(orientation_of(affine_map(ux, uy, vx, vy, true)));
  EXPECT_EQ(rounded, orientation_words(orientation_of(affine_map(ux, uy, vx, vy, false))));
  return rounded;
}

TEST(Orientation, TurnsByHand) {
  EXPECT_EQ(words(1.3, 0.1, -0.1, 1.2), "upright");
  // Turned clockwise, the picture's columns run down the camera's picture, its rows to the left.
  EXPECT_EQ(words(0.1, 1.3, -1.2, 0.1), "turned by 90° clockwise");
  EXPECT_EQ(words(-1.3, 0.1, 0.1, -1.2), "turned by 180° clockwise");
  EXPECT_EQ(words(0.1, -1.3, 1.2, 0.1), "turned by 270° clockwise");
}

TEST(Orientation, MirrorsByHand) {
  EXPECT_EQ(words(-1.3, 0.1, 0.1, 1.2), "mirrored: columns run backwards");
  EXPECT_EQ(words(1.3, 0.1, 0.1, -1.2), "mirrored: rows run backwards");
  EXPECT_EQ(words(0.1, 1.3, 1.2, 0.1), "mirrored: columns and rows are exchanged");
}

TEST(Orientation, IsNotToldFromTooLittle) {
  EXPECT_FALSE(orientation_of(DecodedMap(80, 60)).known);
  DecodedMap half = affine_map(1, 0, 0, 1, false);
  const DecodedMap mirrored = affine_map(-1, 0, 0, 1, false);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 80; ++x) half.u_px(x, y) = mirrored.u_px(x, y);
  EXPECT_FALSE(orientation_of(half).known);
  EXPECT_THAT(orientation_words(orientation_of(half)), ::testing::HasSubstr("not to be told"));
}

}  // namespace
}  // namespace laterna
