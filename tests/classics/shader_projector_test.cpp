// Row 5: the shader lecture.
#include "tests/classics/made.h"

#include <gtest/gtest.h>

namespace laterna {
namespace {

using laterna::testing::made_classic;

double found(const std::string& name) { return figure(made_classic("shader_projector"), name); }

TEST(ShaderProjector, TheDivideBelongsToTheFragment) {
  EXPECT_LT(found("divide per fragment to the core's (u, v), greatest"), 1e-9);  // doubles, of 1e3 px
  EXPECT_GT(found("divide per vertex to the core's (u, v), greatest"), 1);       // a texel and more
}

TEST(ShaderProjector, ATestOfRIsTheNearPlane) {
  EXPECT_GT(found("near plane at 3.4 m: pixels with q > 0"),
            found("near plane at 3.4 m: pixels with r > 0") + 1000);
  EXPECT_EQ(found("pixels where q > 0 and not r > 0 is not the core's near plane"), 0);
}

TEST(ShaderProjector, FixedInTheWorldOrToTheEye) {
  EXPECT_LT(found("fixed in the world: (u, v) of a point after the camera moved, greatest change"), 1e-9);
  EXPECT_GT(found("fixed to the eye: (u, v) of a point after the camera moved, greatest change"), 10);
  EXPECT_LT(found("fixed to the eye: the slide's place in the picture, greatest change"), 1e-9);
}

TEST(ShaderProjector, OcclusionIsMissingAndCured) {
  EXPECT_GT(found("share of lit pixels that the slide reaches through other things"), 0.05);
  EXPECT_EQ(found("pixels that the cure darkens without an occluder"), 0);
}

}  // namespace
}  // namespace laterna
