#include "render/effects/solid_albedo.h"

#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

namespace laterna {
namespace {

TEST(SolidAlbedo, CheckerByHand) {
  const Solid solid{SolidKind::checker, 0.1, 0.25};
  EXPECT_EQ(solid_share(solid, 1, {0, 0, 0}), 1);
  EXPECT_EQ(solid_share(solid, 1, {0.1, 0, 0}), 0.25);
  EXPECT_EQ(solid_share(solid, 1, {0.1, 0.1, 0}), 1);
  EXPECT_EQ(solid_share(solid, 1, {-0.1, 0.1, 0.1}), 0.25);
  EXPECT_EQ(solid_share(solid, 1, {0.074, 0, 0}), 1);  // boundaries at 0.075, 0.175, ...
  EXPECT_EQ(solid_share(solid, 1, {0.076, 0, 0}), 0.25);
}

TEST(SolidAlbedo, NoiseIsSmoothBoundedAndDrawnBySeed) {
  const Solid solid{SolidKind::noise, 0.5, 0.2};
  auto random = testing::generator();
  std::uniform_real_distribution<double> place(-20, 20);
  double sum = 0;
  int other_seed_differs = 0;
  for (int i = 0; i < 4000; ++i) {
    const glm::dvec3 x(place(random), place(random), place(random));
    const double s = solid_share(solid, 1, x);
    ASSERT_GE(s, 0.2);
    ASSERT_LE(s, 1);
    // |ds/dx| ≤ 0.8·1.5/cell along each axis.
    EXPECT_NEAR(solid_share(solid, 1, x + glm::dvec3(1e-6, 0, 0)), s, 2.5e-6);
    const glm::dvec3 corner = glm::round(x / 0.5) * 0.5;
    other_seed_differs += solid_share(solid, 1, corner) != solid_share(solid, 2, corner);
    sum += solid_share(solid, 1, corner);
  }
  EXPECT_EQ(other_seed_differs, 4000);
  // Uniform on the lattice: σ of the mean is 0.8/√12/√4000 = 0.0037; 5 σ.
  EXPECT_NEAR(sum / 4000, 0.6, 0.019);
  // Midway along an edge the blend is the mean.
  const double a = solid_share(solid, 1, {0, 0, 0}), b = solid_share(solid, 1, {0.5, 0, 0});
  EXPECT_NEAR(solid_share(solid, 1, {0.25, 0, 0}), (a + b) / 2, 1e-15);
}

TEST(SolidAlbedo, StaysOnTheObjectWhereverItStands) {
  Scene scene = testing::facing_plane();
  scene.effects.solid_albedo = true;
  scene.objects[0].effects.solid = {SolidKind::checker, 0.2, 0.5};
  const testing::Lit lit(scene);
  int bright = 0;
  for (std::size_t p = 0; p < lit.size(); ++p) {
    const glm::dvec3 x = lit.points.values[p];
    const bool even = (int(std::floor(x.x / 0.2 + 0.25)) + int(std::floor(x.y / 0.2 + 0.25))) % 2 == 0;
    EXPECT_NEAR(lit.surface.albedo.values[p], even ? 0.8 : 0.4, 1e-7);  // float
    bright += even;
  }
  EXPECT_GT(bright, 500);
  EXPECT_LT(bright, 1900);
}

}  // namespace
}  // namespace laterna
