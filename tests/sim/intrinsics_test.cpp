#include "sim/intrinsics.h"

#include "sim/texture_matrix.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace laterna {
namespace {

TEST(Intrinsics, ThrowRatioByHand) {
  // Throw 1.5: 1.5 m away the picture is 1 m wide. Half a picture of shift puts the axis on the lower edge, v
  // = H - 0.5.
  const Intrinsics k = intrinsics_from_throw({1920, 1080}, 1.5, {0, 0.5});
  EXPECT_DOUBLE_EQ(k.fx, 2880);
  EXPECT_DOUBLE_EQ(k.fy, 2880);
  EXPECT_DOUBLE_EQ(k.cx, 959.5);
  EXPECT_DOUBLE_EQ(k.cy, 1079.5);
}

TEST(Intrinsics, PositiveShiftMovesThePictureUp) {
  // The device's y points down: with the picture moved up, the centre of the picture falls at negative y.
  const Intrinsics k = intrinsics_from_throw({1920, 1080}, 1.5, {0, 0.25});
  const double y_of_picture_centre = ((1080 - 1) / 2.0 - k.cy) / k.fy;
  EXPECT_LT(y_of_picture_centre, 0);
}

TEST(Intrinsics, FieldOfViewReachesTheEdges) {
  const double fov = 40 * std::numbers::pi / 180;
  const Intrinsics a = intrinsics_from_fov_y({1600, 900}, fov, 1600.0 / 900);
  EXPECT_NEAR((899.5 - a.cy) / a.fy, std::tan(fov / 2), 1e-15);  // lower edge; one rounding
  EXPECT_NEAR(a.fx, a.fy, 1e-10);  // square pixels at the natural aspect; 1e3·eps
  const Intrinsics b = intrinsics_from_fov_x({1600, 900}, fov, 1600.0 / 900);
  EXPECT_NEAR((1599.5 - b.cx) / b.fx, std::tan(fov / 2), 1e-15);
  EXPECT_NEAR(b.fx, b.fy, 1e-10);
}

TEST(Intrinsics, AspectIsThePictureOnTheWall) {
  const Intrinsics k = intrinsics_from_fov_y({1000, 1000}, 1.0, 2.0);  // square panel, anamorphic lens
  EXPECT_NEAR((1000 / k.fx) / (1000 / k.fy), 2.0, 1e-12);
}

TEST(Intrinsics, RefusesWhatIsSingular) {
  const auto message = [](Intrinsics k) { return testing::input_error([&] { validate(k, "left"); }); };
  EXPECT_THAT(message({{0, 10}, 1, 1, 0, 0}), ::testing::HasSubstr("left: size is 0 × 10"));
  EXPECT_THAT(message({{10, 1000000}, 1, 1, 0, 0}), ::testing::HasSubstr("16384"));
  EXPECT_THAT(message({{10, 10}, 0, 1, 0, 0}), ::testing::HasSubstr("singular"));
  EXPECT_THAT(message({{10, 10}, 1, -5, 0, 0}), ::testing::HasSubstr("focal length is -5"));
  EXPECT_THAT(message({{10, 10}, 1, 1, std::numeric_limits<double>::quiet_NaN(), 0}),
              ::testing::HasSubstr("nan"));
}

}  // namespace
}  // namespace laterna
