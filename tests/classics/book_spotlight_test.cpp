// Row 2: what must be seen of the course book's spotlight.
#include "render/classic/attenuation_texture.h"
#include "render/classic/intensity_map.h"
#include "sim/scene_file.h"
#include "tests/classics/made.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace laterna {
namespace {

using laterna::testing::classics_folder;
using laterna::testing::made_classic;

double found(const std::string& name) { return figure(made_classic("book_spotlight"), name); }

const std::vector<std::pair<double, double>>& points(const std::string& chart, std::size_t series) {
  for (const LineChart& c : made_classic("book_spotlight").charts)
    if (c.name == chart) return c.series[series].points;
  throw std::logic_error("no chart is called " + chart);
}

// By what the error falls at each doubling, over the whole chart.
double per_doubling(const std::vector<std::pair<double, double>>& p) {
  return std::pow(p.front().second / p.back().second, 1 / std::log2(p.back().first / p.front().first));
}

Projector left() { return load_scene(classics_folder() / "book_spotlight.toml").projectors[0]; }

TEST(BookSpotlight, IntensityMapIsCutoffAndExponent) {
  const Projector projector = left();
  const Image<float> map = intensity_map(projector, 255);
  EXPECT_EQ(map(127, 127), 1.0f);  // the axis goes through the middle texel's centre
  EXPECT_EQ(map(0, 0), 0.0f);      // beyond the cutoff
  // 20° from the axis, within a texel of it: cos¹²20° = 0.474; a texel is 0.2°, the slope there 1.3 % of it.
  const Intrinsics& k = projector.device.intrinsics;
  const double u = k.cx + k.fx * std::tan(20 * std::numbers::pi / 180);
  EXPECT_NEAR(map(int((u + 0.5) / 256 * 255), 127), std::pow(std::cos(20 * std::numbers::pi / 180), 12),
              0.015);
}

TEST(BookSpotlight, IntensityMapComesNearToTheConeWithItsTexels) {
  EXPECT_NEAR(per_doubling(points("book_spotlight_intensity", 1)), 4, 0.1);  // bilinear: 1/n²
  EXPECT_NEAR(per_doubling(points("book_spotlight_intensity", 2)), 2, 0.1);  // nearest: 1/n
  // The cutoff is a step: the texel that holds it is wrong by some of it, over a band of width 1/n.
  EXPECT_NEAR(per_doubling(points("book_spotlight_intensity", 0)), std::sqrt(2), 0.15);
}

TEST(BookSpotlight, HyperbolicDepthIsThatOfTheMatrix) {
  const Projector projector = left();
  const double near_m = *projector.device.planes.near_m, far_m = *projector.device.planes.far_m;
  for (const double depth : {1.0, 1.5, 3.0, 5.9}) {
    const glm::dvec3 x =
        apply(inverse(projector.device.device_from_world), glm::dvec3(0.1 * depth, -0.2 * depth, depth));
    const glm::dvec4 strq = texture_from_world(projector.device) * glm::dvec4(x, 1);
    EXPECT_NEAR(depth_at(strq.z / strq.w, near_m, far_m, DepthIndex::hyperbolic), depth, 1e-12);  // doubles
  }
  // Both readings agree at the planes and nowhere between.
  EXPECT_NEAR(depth_at(1, near_m, far_m, DepthIndex::linear), far_m, 1e-12);
  EXPECT_LT(depth_at(0.5, near_m, far_m, DepthIndex::hyperbolic), 1.8);
  EXPECT_EQ(depth_at(0.5, near_m, far_m, DepthIndex::linear), 3.5);
}

TEST(BookSpotlight, AttenuationTextureComesNearToTheLawUnlessReadAsLinear) {
  EXPECT_NEAR(per_doubling(points("book_spotlight_attenuation", 1)), 4, 0.2);  // trilinear: 1/n²
  // Beyond the last texel's centre it is clamped: a share 1/n of the points, wrong by 1/n: n^-1.5.
  EXPECT_NEAR(per_doubling(points("book_spotlight_attenuation", 0)), std::pow(2, 1.5), 0.3);
  // A texture of any size read naively stays wrong by half.
  EXPECT_NEAR(per_doubling(points("book_spotlight_attenuation", 2)), 1, 0.05);
  EXPECT_GT(found("attenuation texture of 64 x 64 x 64, r/q read as linear, rms of ratio - 1"), 0.4);
  EXPECT_LT(found("attenuation texture of 64 x 64 x 64, r/q hyperbolic, rms of ratio - 1"), 0.01);
}

TEST(BookSpotlight, ThreePassesAreOne) {
  EXPECT_LT(found("three passes by the law to one, greatest share of peak"), 1e-6);  // the core's floats
  // By textures: 0.01 of the cone at its cutoff by the map, and 0.025 of the distance.
  EXPECT_LT(found("three passes by textures to one, rms share of peak"), 0.01);
}

TEST(BookSpotlight, LightsAdd) {
  EXPECT_LT(found("several lights: both to the sum of each, greatest"), 1e-12);  // doubles
}

TEST(BookSpotlight, BorderTexelFadesAndEdgeClampSmears) {
  EXPECT_GT(found("clamp-to-edge: pixels with light outside the picture"), 0.3);
  EXPECT_GT(found("border texel: pixels with light outside the picture"), 0.01);
  EXPECT_LT(found("border texel: pixels with light outside the picture"), 0.1);
  EXPECT_EQ(found("border texel: of them beyond half a texel"), 0);
  EXPECT_EQ(found("killed: pixels with light outside the picture"), 0);
}

TEST(BookSpotlight, LightPerVertexUndersamples) {
  // Between vertices a smooth light is wrong by its curvature: 1/n², from where the cells are smaller than
  // it.
  const auto smooth = points("book_spotlight_vertices", 1);
  EXPECT_NEAR(per_doubling({smooth.begin() + 3, smooth.end()}), 4, 0.2);
  // A cutoff goes no finer than the cells that it crosses: a band of width 1/n.
  const auto cut = points("book_spotlight_vertices", 0);
  EXPECT_NEAR(per_doubling({cut.begin() + 3, cut.end()}), std::sqrt(2), 0.15);
}

}  // namespace
}  // namespace laterna
