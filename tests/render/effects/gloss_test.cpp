#include "render/effects/gloss.h"

#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

#include <numbers>

namespace laterna {
namespace {

using testing::Lit;
constexpr double pi = std::numbers::pi;
const Gloss phong{GlossModel::phong, 0.6, 40.0, {}}, ggx{GlossModel::ggx, 0.6, {}, 0.2};

glm::dvec3 direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// ∫ f·cos θ_v dω over the half sphere, by the midpoint rule.
double reflected(const Gloss& gloss, const glm::dvec3& l) {
  const int rings = 400, spokes = 400;
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double theta = (i + 0.5) / rings * pi / 2;
    for (int j = 0; j < spokes; ++j)
      sum += gloss_per_sr(gloss, {0, 0, 1}, l, direction(theta, (j + 0.5) / spokes * 2 * pi)) *
             std::cos(theta) * std::sin(theta);
  }
  return sum * (pi / 2 / rings) * (2 * pi / spokes);
}

TEST(Gloss, ReflectsAtMostItsStrength) {
  for (const Gloss& gloss : {phong, ggx})
    for (const double theta : {0.0, 0.4, 0.9, 1.3, 1.5})
      EXPECT_LE(reflected(gloss, direction(theta, 0.3)), 0.6 * (1 + 1e-4)) << theta;  // 1e-4: quadrature
  // Phong's lobe about the normal reflects k·(e + 2)/(2π) ∫cos^(e+1) = k.
  EXPECT_NEAR(reflected(phong, {0, 0, 1}), 0.6, 1e-4);
  // A smooth ggx loses little to shadowing: 1 - G is of the order of α²/4·tan².
  EXPECT_NEAR(reflected({GlossModel::ggx, 0.6, {}, 0.05}, {0, 0, 1}), 0.6, 0.01);
}

TEST(Gloss, PeaksByHandInTheMirrorDirection) {
  const glm::dvec3 n(0, 0, 1), l = direction(0.5, 0), mirror = direction(0.5, pi);
  EXPECT_NEAR(gloss_per_sr(phong, n, l, mirror), 0.6 * 42 / (2 * pi), 1e-12);
  // h = n: D = 1/(πα²); along the normal G = 1.
  EXPECT_NEAR(gloss_per_sr(ggx, n, n, n), 0.6 / (pi * 0.04) / 4, 1e-12);
  for (const Gloss& gloss : {phong, ggx}) {
    const double peak = gloss_per_sr(gloss, n, l, mirror);
    for (const double aside : {-0.2, 0.2}) {
      EXPECT_LT(gloss_per_sr(gloss, n, l, direction(0.5, pi + aside)), peak);
      EXPECT_LT(gloss_per_sr(gloss, n, l, direction(0.5 - std::abs(aside), pi)), peak);
    }
    EXPECT_EQ(gloss_per_sr(gloss, n, l, -mirror), 0);
    EXPECT_NEAR(gloss_per_sr(gloss, n, l, direction(0.2, 1)), gloss_per_sr(gloss, n, direction(0.2, 1), l),
                1e-12);  // reciprocity
  }
}

// The picture's brightness is albedo/π·white_lx: it grows by f_gloss·E, also on a black object.
TEST(Gloss, AddsItsLightToThePicture) {
  Scene scene = testing::scene_of({testing::object_of(plane(4, 4))},
                                  testing::device_at({0.4, 0, 2}, {0, 0, 0}, {61, 41}, 80),
                                  testing::device_at({-0.4, 0, 2}, {0, 0, 0}, {100, 80}, 60));
  for (const double albedo : {0.3, 0.0}) {
    scene.objects[0].albedo = albedo;
    scene.effects.gloss = false;
    const Lit plain(scene);
    scene.effects.gloss = true;
    scene.objects[0].effects.gloss = ggx;
    const Lit lit(scene);
    std::size_t brightest = 0;
    for (std::size_t p = 0; p < lit.size(); ++p) {
      const glm::dvec3 x = lit.points.values[p];
      const double f = gloss_per_sr(ggx, {0, 0, 1}, glm::normalize(glm::dvec3(-0.4, 0, 2) - x),
                                    glm::normalize(glm::dvec3(0.4, 0, 2) - x));
      const double light = lit.surface.albedo.values[p] / pi * lit.light().white_lx.values[p];
      // 2e-6: the least albedo in place of 0, and its float.
      EXPECT_NEAR(light, (albedo / pi + f) * plain.light().white_lx.values[p], 2e-6 * (light + 500));
      if (lit.light().white_lx.values[p] > lit.light().white_lx.values[brightest]) brightest = p;
    }
    // The mirror point lies midway, behind the picture's centre; 1 px: E tilts the peak a little.
    EXPECT_NEAR(double(brightest % 61), 30, 1.0);
    EXPECT_NEAR(double(brightest / 61), 20, 1.0);
  }
}

}  // namespace
}  // namespace laterna
