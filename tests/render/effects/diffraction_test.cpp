// The Airy pattern: encircled light, and how projectors and cameras spread by it.
#include "render/effects/diffraction.h"

#include "render/pixel_samples.h"
#include "tests/render/rig.h"
#include "tests/testing.h"

#include <numbers>

namespace laterna {
namespace {

using testing::device_at;
using testing::object_of;
using testing::scene_of;

// 1 - J0² - J1² from the integral J_n(x) = 1/π ∫ cos(nτ - x sin τ) dτ.
double encircled(double radius) {
  const double x = std::numbers::pi * radius;
  double j[2] = {0, 0};
  constexpr int steps = 2000;
  for (int i = 0; i < steps; ++i) {
    const double tau = (i + 0.5) / steps * std::numbers::pi;
    for (int n : {0, 1}) j[n] += std::cos(n * tau - x * std::sin(tau)) / steps;
  }
  return 1 - j[0] * j[0] - j[1] * j[1];
}

TEST(Diffraction, FirstDarkRingAndEncircledLight) {
  const auto circles = airy_circles();
  EXPECT_NEAR(circles[4].radius, 1.22, 0.0005);  // as the textbooks round it
  const double whole = encircled(circles.back().radius);
  EXPECT_NEAR(whole, 0.961, 0.0005);
  for (const AiryCircle& circle : circles)
    EXPECT_NEAR(circle.share, encircled(circle.radius) / whole, 1e-9) << circle.radius;  // quadrature
  EXPECT_NEAR(circles[4].share * whole, 0.838, 0.0005);
}

TEST(Diffraction, TheSumOfDiscsEncirclesTheSameLight) {
  const std::vector<DiscShare> discs = airy_discs(2);
  for (const AiryCircle& circle : airy_circles()) {
    double share = 0;
    for (const DiscShare& disc : discs) {
      EXPECT_GT(disc.share, 0);
      share += disc.share * std::min(1.0, std::pow(2 * circle.radius * 2 / disc.diameter_px, 2));
    }
    EXPECT_NEAR(share, circle.share, 1e-12);  // roundings
  }
}

TEST(Diffraction, EvenPointsGiveThePattern) {
  const auto circles = airy_circles();
  EXPECT_EQ(airy_point({0, 0}), glm::vec2(0, 0));
  for (const AiryCircle& circle : circles.subspan(1)) {
    const auto radius = float(std::sqrt(circle.share));
    EXPECT_NEAR(glm::length(airy_point({0, radius})), circle.radius,
                1e-4);  // single precision, steep outside
  }
}

TEST(Diffraction, TheRealRigsPatternIsSmall) {
  const Intrinsics k{{1920, 1080}, 2842.98, 2844.47, 958.83, 1096.37};
  EXPECT_NEAR(1.22 * airy_unit_px({.aperture_m = 7.19e-3}, k), 0.265, 0.001);
  EXPECT_EQ(airy_unit_px({}, k), 0);
}

// Camera and projector at one place before a plane, pixel for pixel.
Scene coaxial(int samples) {
  Scene scene = scene_of({object_of(plane(40, 40))}, device_at({0, 0, 2}, {0, 0, 0}, {24, 24}, 100),
                         device_at({0, 0, 2}, {0, 0, 0}, {60, 60}, 100));
  scene.effects.diffraction = true;
  scene.cameras[0].samples_per_pixel = samples;
  return scene;
}

LightRows rows_of(const Scene& scene) {
  const RayScene rays(scene);
  const CameraRays directions(scene.cameras[0].device);
  LightRows rows;
  rows.region = {0, 0, 24, 24};
  trace_rows(rays, scene, 0, directions, 0, samples_of(scene, 0, testing::seed()))(rows);
  return rows;
}

TEST(Diffraction, ACamerasRaysSpreadAsThePattern) {
  Scene scene = coaxial(16);
  scene.cameras[0].optics.aperture_m = 50e-6;  // λ/A = 0.011: 1.1 px
  const LightRows rows = rows_of(scene);
  ASSERT_EQ(rows.entries.size(), 24u * 24 * 16);
  const auto circles = airy_circles();
  for (const AiryCircle& circle : circles) {
    double within = 0;
    for (std::size_t p = 0; p < rows.region.size(); ++p) {
      const glm::dvec2 center(p % 24 + 18.0, p / 24 + 18.0);
      for (std::uint32_t e = rows.begin[p]; e < rows.begin[p + 1]; ++e)
        within += glm::length(glm::dvec2(rows.entries[e].u_px, rows.entries[e].v_px) - center) <=
                  1.1 * circle.radius + 1e-4;
    }
    // 9216 rays, binomial: at most 0.5/96 in sigma; four of these.
    EXPECT_NEAR(within / 9216, circle.share, 0.02) << circle.radius;
  }
}

TEST(Diffraction, AProjectorsEntriesSpreadOverPixels) {
  Scene scene = coaxial(1);
  scene.projectors[0].effects.optics.aperture_m = 25e-6;  // λ/A: 2.2 px
  EXPECT_FALSE(rows_are_direct(scene, 0));
  const LightRows rows = rows_of(scene);
  scene.effects.diffraction = false;
  const LightRows sharp = rows_of(scene);
  for (const std::size_t p : {0u, 12u * 24 + 7, 24u * 24 - 1}) {
    const glm::dvec2 center(p % 24 + 18.0, p / 24 + 18.0);
    double sum = 0, within = 0;
    for (std::uint32_t e = rows.begin[p]; e < rows.begin[p + 1]; ++e) {
      sum += rows.entries[e].weight;
      const glm::dvec2 d = glm::dvec2(rows.entries[e].u_px, rows.entries[e].v_px) - center;
      within += glm::length(d) <= 2.2 * 1.2197 ? rows.entries[e].weight : 0;
    }
    ASSERT_EQ(sharp.begin[p + 1] - sharp.begin[p], 1u);
    EXPECT_NEAR(sum / sharp.entries[sharp.begin[p]].weight, 1, 1e-9);  // the light is kept
    EXPECT_NEAR(within / sum, 0.838 / 0.961, 0.06);  // whole pixels, of which the ring cuts 16 dim ones
  }
}

}  // namespace
}  // namespace laterna
