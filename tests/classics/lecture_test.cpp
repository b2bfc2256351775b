// Row 3: the texture-mapping lecture.
#include "tests/classics/made.h"

#include <gtest/gtest.h>

namespace laterna {
namespace {

using laterna::testing::made_classic;

double found(const std::string& name) { return figure(made_classic("lecture"), name); }

TEST(Lecture, APhotographPutOnItsObjectsAndTakenAgainIsItself) {
  const double coarse = found("photograph taken again, 256 texels: rms"),
               middle = found("photograph taken again, 512 texels: rms"),
               fine = found("photograph taken again, 1024 texels: rms");
  // Edges of the slide are a texel wide in the texture: the squared error falls as the texel does, or faster.
  EXPECT_LT(middle, 0.71 * coarse);
  EXPECT_LT(fine, 0.71 * middle);
  EXPECT_LT(fine, 2.0);  // DN, of 255
}

TEST(Lecture, LightMapsServeAnotherView) {
  // Edges of slide and shadow, which are a camera pixel wide in the map, hold all of it: 3 % of pixels by the
  // whole contrast.
  EXPECT_LT(found("light maps from another place: rms share of the brightest"), 0.05);
  EXPECT_GT(found("light maps from another place: share of the picture"), 0.7);
}

TEST(Lecture, ShadowMapsComeNearShadowRaysWithTexelsAndBias) {
  const ClassicResult& made = made_classic("lecture");
  ASSERT_EQ(made.charts.size(), 1u);
  for (const auto& series : made.charts[0].series) {
    ASSERT_EQ(series.points.size(), 6u);
    if (series.name == "bias 0 mm") continue;
    EXPECT_LT(series.points.back().second, 0.3 * series.points.front().second)
        << series.name;  // 32 times the texels
  }
  // Without a bias half of all texels' middles are nearer than the surface beside them.
  EXPECT_NEAR(found("shadow map of 256 x 256, no bias: judged wrongly"), 0.5, 0.1);
  EXPECT_LT(found("shadow map of 256 x 256, bias 10 mm: judged wrongly"), 0.05);
}

TEST(Lecture, PhongIsASumAndShinesWhereTheMirrorDoes) {
  EXPECT_LT(found("Phong: whole to ambient + diffuse + specular, greatest share of the brightest"),
            1e-5);  // floats
  // The ball's facets are 3.75° wide: a flat one mirrors within half of it, doubled, and a pixel more.
  EXPECT_LT(found("Phong: the highlight from the mirror direction"), 5);
}

TEST(Lecture, OnlyDisplacementMovesTheOutline) {
  EXPECT_EQ(found("solid texture: pixels of the ball's outline that moved"), 0);
  EXPECT_EQ(found("bump map: pixels of the ball's outline that moved"), 0);
  EXPECT_GT(found("displacement map: pixels of the ball's outline that moved"), 100);
}

TEST(Lecture, PenetrationAndReverseProjectionAreShownAndCured) {
  EXPECT_GT(found("penetration: share of the picture"), 0.01);
  EXPECT_EQ(found("penetration, cured"), 0);
  EXPECT_GT(found("reverse projection: share of the picture"), 0.01);
  EXPECT_EQ(found("reverse projection, cured"), 0);
}

}  // namespace
}  // namespace laterna
