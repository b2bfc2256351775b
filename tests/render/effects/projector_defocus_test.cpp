// A projector's blur disc over depth, its light and its border.
#include "render/effects/projector_defocus.h"

#include "render/transpose.h"
#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

#include <numbers>

namespace laterna {
namespace {

using testing::device_at;
using testing::object_of;
using testing::scene_of;

TEST(ProjectorDefocus, TheRealRigsBlur) {
  const Intrinsics k{{1920, 1080}, 2842.98, 2844.47, 958.83, 1096.37};
  const Optics optics{.aperture_m = 7.19e-3, .focus_m = 0.490};
  EXPECT_EQ(blur_diameter_px(optics, k, 0.490), 0);
  // To the digits that are stated for this rig.
  EXPECT_NEAR(blur_diameter_px(optics, k, 0.535), 3.5, 0.05);
  EXPECT_NEAR(blur_diameter_px(optics, k, 1.2), 25, 0.5);
  EXPECT_EQ(blur_diameter_px({}, k, 1), 0);
}

// Projector and camera at one place, z metres before a plane; a camera pixel is 1/4 of a projector pixel.
Scene coaxial(double z) {
  Scene scene = scene_of({object_of(plane(40, 40))}, device_at({0, 0, z}, {0, 0, 0}, {160, 120}, 400),
                         device_at({0, 0, z}, {0, 0, 0}, {25, 17}, 100));
  scene.projectors[0].effects.optics = {.aperture_m = 0.1, .focus_m = 2};
  return scene;
}

ImageRows rows_of(const Scene& scene, const RayScene& rays, const CameraRays& directions) {
  return {{directions.width(), directions.height()}, trace_rows(rays, scene, 0, directions, 0)};
}

struct Rig {
  Scene scene;
  RayScene rays{scene};
  CameraRays directions{scene.cameras[0].device};
  ImageRows image{rows_of(scene, rays, directions)};
};

PatternStack one_pixel_lit(int x, int y) {
  PatternStack pattern = testing::constant_pattern({25, 17}, 1, 0);
  pattern.values[std::size_t(y) * 25 + x] = 255;
  return pattern;
}

TEST(ProjectorDefocus, OnePixelBlursToTheDisc) {
  for (const double z : {1.25, 1.6, 2.0, 3.0, 6.0}) {
    Scene scene = coaxial(z);
    scene.effects.projector_defocus = true;
    const Rig rig{scene};
    const ImageStack<float> picture = play_luminance(rig.image, Lookup::nearest, one_pixel_lit(12, 8));
    const Rig sharp{coaxial(z)};
    const ImageStack<float> unblurred = play_luminance(sharp.image, Lookup::nearest, one_pixel_lit(12, 8));
    double sum = 0, sum_x2 = 0, sum_y2 = 0, before = 0;
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) {
        const double light = picture.values[y * 160 + x], u = (x - 79.5) / 4, v = (y - 59.5) / 4;
        sum += light, sum_x2 += light * u * u, sum_y2 += light * v * v;
        before += unblurred.values[y * 160 + x];
      }
    }
    const double diameter = 100 * 0.1 * std::abs(1 / 2.0 - 1 / z);
    // Total light: sums of camera pixels of 1/4 px stand for integrals over a function with an even,
    // piecewise smooth outline: 1 %. The plane faces the projector, so its irradiance is the same all over.
    EXPECT_NEAR(sum / before, 1, 0.01) << z;
    // Along each axis a disc has d²/16 and a pixel 1/12; camera pixels sample that at 1/4 px (1/192).
    EXPECT_NEAR(sum_x2 / sum, diameter * diameter / 16 + 1.0 / 12, 0.01) << z;
    EXPECT_NEAR(sum_y2 / sum, diameter * diameter / 16 + 1.0 / 12, 0.01) << z;
  }
}

TEST(ProjectorDefocus, TheBorderIsTheDiscsEdgeSpread) {
  Scene scene = coaxial(1.25);  // a disc of 3 px
  scene.effects.projector_defocus = true;
  const Rig rig{scene};
  const auto picture =
      play_luminance(rig.image, Lookup::nearest, testing::constant_pattern({25, 17}, 1, 255));
  const double white = picture.values[60 * 160 + 80];
  int beyond = 0;
  for (int x = 100; x < 160; ++x) {
    const double t = (12.5 - (x - 79.5) / 4) / 1.5;  // radii inside the panel's right edge
    const double c = std::clamp(t, -1.0, 1.0);
    const double expected = 0.5 + (std::asin(c) + c * std::sqrt(1 - c * c)) / std::numbers::pi;
    EXPECT_NEAR(picture.values[60 * 160 + x] / white, expected, 1e-6) << x;  // single precision
    beyond += t < 0 && picture.values[60 * 160 + x] > 0;
  }
  EXPECT_EQ(beyond, 6);  // 1.5 px of the projector are 6 of the camera
}

TEST(ProjectorDefocus, TheTransposeHolds) {
  Scene scene = coaxial(1.6);
  scene.effects.projector_defocus = true;
  const Rig rig{scene};
  auto generator = testing::generator();
  std::uniform_int_distribution<int> value(0, 255);
  PatternStack p = testing::constant_pattern({25, 17}, 1, 0);
  for (std::uint8_t& v : p.values) v = std::uint8_t(value(generator));
  Image<float> y(160, 120);
  for (float& v : y.values) v = float(value(generator)) / 255;
  const auto ap = play_luminance(rig.image, Lookup::nearest, p);
  const Image<double> aty = apply_transpose(rig.image, Lookup::nearest, y, {25, 17});
  double left = 0, right = 0;
  for (std::size_t i = 0; i < y.values.size(); ++i) left += double(y.values[i]) * ap.values[i];
  for (std::size_t i = 0; i < p.values.size(); ++i) right += p.values[i] / 255.0 * aty.values[i];
  EXPECT_NEAR(left / right, 1, 1e-6);  // play_luminance sums in single precision
}

TEST(ProjectorDefocus, FootprintsStandOnTheMap) {
  Scene scene = coaxial(1.25);
  EXPECT_TRUE(testing::Lit(scene).light().footprint_px.values.empty());
  scene.effects.projector_defocus = true;
  const testing::Lit lit(scene);
  for (std::size_t p = 0; p < lit.size(); ++p)
    EXPECT_NEAR(lit.light().footprint(p), lit.light().lit(p) ? 3 : 0, 1e-6);  // single precision
}

TEST(ProjectorDefocus, StripesFadeAsTheDiscsTransfer) {
  EXPECT_EQ(stripe_contrast(0, 2), 1);
  EXPECT_NEAR(stripe_contrast(2, 2), 0.7217, 1e-4);  // 2·J1(π/2)/(π/2)
  EXPECT_NEAR(stripe_contrast(4.8787, 2), 0, 1e-4);  // J1's first zero: 3.8317
  EXPECT_LT(stripe_contrast(6, 2), -0.1);            // spurious resolution
}

}  // namespace
}  // namespace laterna
