// Row 4: the projected-light tutorial.
#include "tests/classics/made.h"

#include <gtest/gtest.h>

namespace laterna {
namespace {

using laterna::testing::made_classic;

double found(const std::string& name) { return figure(made_classic("projected_light"), name); }

TEST(ProjectedLight, TheStackedMatrixIsT) {
  EXPECT_LT(found("matrix by the stack to the core's (u, v), greatest"), 1e-9);  // doubles, of 1e3 px
}

TEST(ProjectedLight, BackProjectedLightGoesWithTheTestOfQ) {
  EXPECT_GT(found("light behind the projector, no test of q"), 0.01);
  EXPECT_EQ(found("light behind the projector, q > 0"), 0);
}

TEST(ProjectedLight, TheSmearAppearsAndGoes) {
  EXPECT_GT(found("pixels of the smear"), 0.1);
  // The core's picture is in single precision.
  EXPECT_LT(found("the smear to the core's `border = false`, greatest"), 1e-6);
  EXPECT_LT(found("border to the core's picture, greatest"), 1e-6);
}

TEST(ProjectedLight, TheFieldOfViewIsThatOfAFacingWall) {
  for (const char* name :
       {"width on the wall at 20°, over 2z·tan(fov/2)", "width on the wall at 40°, over 2z·tan(fov/2)",
        "width on the wall at 60°, over 2z·tan(fov/2)"}) {
    // A pixel of the camera is some 3 cm of the oblique wall, and the outermost lit ones lie inside: 3 %
    // of 1.2 m.
    EXPECT_GT(found(name), 0.97) << name;
    EXPECT_LE(found(name), 1) << name;
  }
}

TEST(ProjectedLight, AFlashlightEndsAtItsAngle) {
  const double widest = found("flashlight of 16°: widest lit angle");
  EXPECT_LE(widest, 16);
  EXPECT_GT(widest, 15.5);  // a camera pixel is at most half a degree as the torch sees it
}

TEST(ProjectedLight, FourTimesTheIntensityIsFourTimesTheLight) {
  EXPECT_NEAR(found("light of × 4 over light"), 4, 1e-5);  // sums of floats
  EXPECT_GT(found("pixels that clip at × 4"), 0.01);
}

}  // namespace
}  // namespace laterna
