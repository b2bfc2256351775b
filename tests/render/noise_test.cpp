#include "render/noise.h"

#include "tests/testing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laterna {
namespace {

TEST(NormalDeviates, MomentsOfAMillion) {
  const NoiseKey key{testing::seed(), 0, 0};
  double sum = 0, squares = 0, fourth = 0, beyond_two = 0, pairs = 0;
  constexpr int pixels = 250000, n = 4 * pixels;
  for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
    float d[4];
    normal_deviates(key, pixel, 3, d);
    for (const float x : d)
      sum += x, squares += x * x, fourth += std::pow(x, 4), beyond_two += std::abs(x) > 2;
    pairs += d[0] * d[1] + d[2] * d[3];
  }
  // Five standard errors each: 1, √2, √96, √(p(1-p)) and √0.5 over √n.
  const double e = 5 / std::sqrt(n);
  EXPECT_NEAR(sum / n, 0, e);
  EXPECT_NEAR(squares / n, 1, e * std::sqrt(2));
  EXPECT_NEAR(fourth / n, 3, e * std::sqrt(96));
  EXPECT_NEAR(beyond_two / n, 0.0455003, e * std::sqrt(0.0455 * 0.9545));
  EXPECT_NEAR(2 * pairs / n, 0, e * std::sqrt(2));
}

TEST(NormalDeviates, EveryPartOfTheKeyCounts) {
  const auto first = [](const NoiseKey& key, std::uint32_t pixel, std::uint32_t group) {
    float d[4];
    normal_deviates(key, pixel, group, d);
    return d[0];
  };
  const float base = first({1, 0, 0}, 5, 2);
  EXPECT_EQ(base, first({1, 0, 0}, 5, 2));
  EXPECT_NE(base, first({2, 0, 0}, 5, 2));
  EXPECT_NE(base, first({1 + (1ull << 32), 0, 0}, 5, 2));
  EXPECT_NE(base, first({1, 1, 0}, 5, 2));
  EXPECT_NE(base, first({1, 0, 1}, 5, 2));
  EXPECT_NE(base, first({1, 0, 0}, 6, 2));
  EXPECT_NE(base, first({1, 0, 0}, 5, 3));
}

}  // namespace
}  // namespace laterna
