// A camera's blur disc over depth, from the edge of a half plane.
#include "render/effects/camera_defocus.h"

#include "tests/render/rig.h"
#include "tests/testing.h"

#include <numbers>

namespace laterna {
namespace {

using testing::device_at;
using testing::object_of;
using testing::scene_of;

constexpr int width = 24, height = 60;
constexpr double focal_px = 100, edge_px = 13.3;

// A plane at depth z that ends at column edge_px, focus at 2 m.
Scene half_plane(double z) {
  const double edge_m = (edge_px - (width - 1) / 2.0) / focal_px * z;
  Scene scene = scene_of({object_of(plane(40, 40), {edge_m - 20, 0, 2 - z})},
                         device_at({0, 0, 2}, {0, 0, 0}, {width, height}, focal_px),
                         device_at({0, 0, 2}, {0, 0, 0}, {8, 8}, 3));
  scene.cameras[0].optics = {.aperture_m = 0.1, .focus_m = 2};
  scene.cameras[0].samples_per_pixel = 64;
  scene.effects.camera_defocus = true;
  return scene;
}

std::vector<double> mean_over_rows(const Scene& scene) {
  const RayScene rays(scene);
  const CameraRays directions(scene.cameras[0].device);
  const ImageRows image{{width, height},
                        trace_rows(rays, scene, 0, directions, 0, samples_of(scene, 0, testing::seed()))};
  const auto picture = play_luminance(image, Lookup::nearest, testing::constant_pattern({8, 8}, 1, 255));
  std::vector<double> columns(width, 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) columns[x] += picture.values[y * width + x] / height;
  return columns;
}

TEST(CameraDefocus, AnEdgeSpreadsAsTheDisc) {
  for (const double z : {1.0, 1.5, 2.0, 4.0, 10.0}) {
    const std::vector<double> columns = mean_over_rows(half_plane(z));
    const double radius = focal_px * 0.1 * std::abs(1 / 2.0 - 1 / z) / 2;
    const double white = columns[int(edge_px) - 8];
    for (int x = int(edge_px) - 7; x <= int(edge_px) + 8; ++x) {
      const double t = radius > 0 ? std::clamp((edge_px - x) / radius, -1.0, 1.0) : (x < edge_px ? 1 : -1);
      const double expected = 0.5 + (std::asin(t) + t * std::sqrt(1 - t * t)) / std::numbers::pi;
      // Of 8×8 cells of the aperture an edge cuts some 10, each at most 1/2 off in sigma: 10^½/2/64/60^½ =
      // 0.0032; five of these; and the light's fall over a few columns, 0.5 %.
      EXPECT_NEAR(columns[x] / white, expected, 0.02) << z << " " << x;
    }
  }
}

TEST(CameraDefocus, LensPointsFillTheAperture) {
  const Optics optics{.aperture_m = 0.1, .focus_m = 2};
  const PixelSamples samples{256, testing::seed(), 0};
  glm::dvec2 mean(0);
  double mean_r2 = 0;
  for (int s = 0; s < 256; ++s) {
    const glm::dvec2 at = lens_point_m(optics, samples, 0, {3, 4}, s);
    ASSERT_LE(glm::length(at), 0.05 * (1 + 1e-6));  // single precision
    mean += at / 256.0, mean_r2 += glm::dot(at, at) / 256;
  }
  // An even disc has r²/2. Stratified: each of 256 points moves within 1/16 of the diameter, 0.002 m in
  // sigma, over 16: five times 1e-4 m.
  EXPECT_LT(glm::length(mean), 6e-4);
  EXPECT_NEAR(mean_r2, 0.05 * 0.05 / 2, 0.05 * 6e-4);
  EXPECT_EQ(lens_point_m(optics, {}, 0, {3, 4}, 0), glm::vec2(0, 0));
}

TEST(CameraDefocus, UsesShareNoOrder) {
  // Whether pixel and aperture points of one ray go together: the mean of their products over pixels.
  double products = 0;
  int same = 0;
  for (int x = 0; x < 200; ++x) {
    std::vector<int> seen(16, 0);
    for (int s = 0; s < 16; ++s) {
      const glm::vec2 a = stratified_square({16, 7}, 0, {x, 0}, s, SampleUse::pixel);
      const glm::vec2 b = stratified_square({16, 7}, 0, {x, 0}, s, SampleUse::aperture);
      products += double(a.x) * b.x / 3200;
      const int cell = int((b.y + 0.5f) * 4) * 4 + int((b.x + 0.5f) * 4);
      ++seen[cell];
      same += cell == s;
    }
    ASSERT_EQ(seen, std::vector<int>(16, 1)) << x;  // each cell once
  }
  // 3200 products of sigma 1/12 each: 0.0015, five times.
  EXPECT_NEAR(products, 0, 0.0075);
  EXPECT_NEAR(same, 200, 70);  // one in 16, Poisson: five sigma
}

TEST(CameraDefocus, OffLeavesNoTrace) {
  Scene scene = half_plane(1.5);
  scene.effects.camera_defocus = false;
  EXPECT_EQ(samples_of(scene, 0, 1).count, 1);
  EXPECT_TRUE(rows_are_direct(scene, 0));
}

}  // namespace
}  // namespace laterna
