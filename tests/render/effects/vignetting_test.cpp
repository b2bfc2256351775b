#include "render/effects/vignetting.h"

#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

namespace laterna {
namespace {

using testing::facing_plane;
using testing::Lit;

TEST(Vignetting, SharesByHand) {
  const glm::ivec2 size(8, 4);
  EXPECT_EQ(vignetting_share({}, nullptr, 3, {0, 0}, size), 1);
  EXPECT_EQ(vignetting_share({VignettingModel::cos4}, nullptr, 1, {0, 0}, size), 0.25);  // cos⁴ 45°
  const Vignetting polynomial{VignettingModel::polynomial, {-0.5, 0.25}};
  EXPECT_EQ(vignetting_share(polynomial, nullptr, 2, {0, 0}, size), 1 - 0.5 * 2 + 0.25 * 4);
  EXPECT_EQ(vignetting_share({VignettingModel::polynomial, {-1}}, nullptr, 2, {0, 0}, size), 0);
}

TEST(Vignetting, AMapSpansThePicture) {
  Image<float> map(4, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x) map(x, y) = 0.125f * float(x) + 0.25f * float(y);
  const Vignetting vignetting{VignettingModel::map, {}, "map"};
  // The map's texel centres, where a picture of twice the size has pixel borders.
  EXPECT_EQ(vignetting_share(vignetting, &map, 0, {0.5, 0.5}, {8, 4}), 0);
  EXPECT_EQ(vignetting_share(vignetting, &map, 0, {4.5, 2.5}, {8, 4}), 0.5);
  EXPECT_EQ(vignetting_share(vignetting, &map, 0, {3.5, 1.5}, {8, 4}), 0.125 * 1.5 + 0.125);
  EXPECT_EQ(vignetting_share(vignetting, &map, 0, {-0.5, -0.5}, {8, 4}), 0);  // the edge texel's
}

TEST(Vignetting, AFacingPlaneFallsAsCos4OfTheProjector) {
  Scene scene = facing_plane();
  const Lit plain(scene);
  scene.effects.projector_vignetting = true;
  scene.projectors[0].effects.vignetting.model = VignettingModel::cos4;
  const Lit dimmed(scene);
  for (std::size_t p = 0; p < plain.size(); ++p) {
    const glm::dvec3 d = plain.points.values[p] - glm::dvec3(0.2, -0.1, 2);
    const double cos_theta = 2 / glm::length(d);
    EXPECT_NEAR(dimmed.light().white_lx.values[p], plain.light().white_lx.values[p] * std::pow(cos_theta, 4),
                1e-9);  // rounding of 450 lx
  }
}

TEST(Vignetting, ACameraDimsWhatItSees) {
  Scene scene = facing_plane();
  scene.effects.camera_vignetting = true;
  scene.cameras[0].vignetting = {VignettingModel::polynomial, {-0.8}};
  const Lit lit(scene);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) {
      const glm::dvec2 t = (glm::dvec2(x, y) - glm::dvec2(29.5, 19.5)) / 80.0;
      EXPECT_NEAR(lit.surface.albedo(x, y), 0.8 * (1 - 0.8 * glm::dot(t, t)), 1e-6);  // floats
    }
  }
}

}  // namespace
}  // namespace laterna
