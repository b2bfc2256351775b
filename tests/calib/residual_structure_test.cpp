#include "calib/residual_structure.h"

#include "tests/calib/synthetic.h"
#include "tests/testing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laterna {
namespace {

// Blocks of 40×40 px over the image, `per_block` points each, with noise of 0.3 px and a shift of (0,
// amplitude·sin(u/200)).
PointTable table(double amplitude, int per_block, std::mt19937_64& random, Device& device) {
  device = testing::usual_projector();
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal(0, 0.3);
  Correspondences c;
  std::uint32_t block = 0;
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 16; ++x, ++block)
      for (int k = 0; k < per_block; ++k) {
        const glm::dvec2 pixel(80 * x + 80 * uniform(random), 80 * y + 80 * uniform(random));
        testing::add_point(c, device, pixel, 1.5 + uniform(random), 0.3);
        c.projector_pixels.back() +=
            glm::dvec2(normal(random), normal(random) + amplitude * std::sin(pixel.x / 200));
        c.cluster.push_back(block);
      }
  return point_table(c, {});
}

std::optional<ResidualStructure> structure(double amplitude, int per_block, std::mt19937_64& random) {
  Device device;
  const PointTable points = table(amplitude, per_block, random, device);
  return residual_structure(points, LensGradient("LENSMODEL_PINHOLE"), state_of(device));
}

// Under independence z has mean 0 and a standard deviation of about 1: of 40 the mean lies within 4/√40, the
// rms below 1.5.
TEST(ResidualStructure, NoiseHasNone) {
  auto random = testing::generator();
  double sum = 0, squares = 0;
  constexpr int trials = 40;
  for (int k = 0; k < trials; ++k) {
    const auto s = structure(0, 20, random);
    ASSERT_TRUE(s);
    sum += s->moran_z, squares += s->moran_z * s->moran_z;
  }
  EXPECT_NEAR(sum / trials, 0, 0.7);
  EXPECT_LT(std::sqrt(squares / trials), 1.5);
}

// A wave of 0.1 px amplitude, a third of the noise: its rms is 0.1/√2, and the blocks see it smoothed by 4 %
// at most.
TEST(ResidualStructure, AWaveIsSeenThroughTheNoise) {
  auto random = testing::generator();
  const auto s = structure(0.1, 60, random);
  ASSERT_TRUE(s);
  EXPECT_GT(s->moran_z, 8);
  EXPECT_NEAR(s->smooth_rms_px, 0.0707, 0.015);
}

TEST(ResidualStructure, NoneWithTooFewPoints) {
  auto random = testing::generator();
  EXPECT_FALSE(structure(0, 7, random));
}

}  // namespace
}  // namespace laterna
