#include "apps/lab/dataset/random_stream.h"

#include <gmock/gmock.h>

#include <cmath>

namespace laterna {
namespace {

TEST(RandomStream, DependsOnSeedSampleAttemptAndNameAlone) {
  RandomStream a(1, 2, 3, "camera.fx"), same(1, 2, 3, "camera.fx");
  const std::uint64_t first = a.bits();
  EXPECT_EQ(first, same.bits());
  EXPECT_NE(first, a.bits());
  EXPECT_NE(first, RandomStream(9, 2, 3, "camera.fx").bits());
  EXPECT_NE(first, RandomStream(1, 9, 3, "camera.fx").bits());
  EXPECT_NE(first, RandomStream(1, 2, 9, "camera.fx").bits());
  EXPECT_NE(first, RandomStream(1, 2, 3, "camera.fy").bits());
}

TEST(RandomStream, MomentsAreThoseOfTheDistributions) {
  constexpr int n = 20000;
  double unit = 0, normal = 0, square = 0;
  int ones = 0;
  for (int k = 0; k < n; ++k) {  // one number of each sample, as a data set draws them
    RandomStream stream(5, std::uint64_t(k), 0, "x");
    unit += stream.unit();
    const double x = stream.normal();
    normal += x, square += x * x;
    ones += stream.below(4) == 1;
  }
  // Four standard deviations of each mean: 1/√12, 1, √2 and √3/4 over √n.
  EXPECT_NEAR(unit / n, 0.5, 4 * 0.2887 / std::sqrt(n));
  EXPECT_NEAR(normal / n, 0, 4 / std::sqrt(n));
  EXPECT_NEAR(square / n, 1, 4 * 1.4143 / std::sqrt(n));
  EXPECT_NEAR(double(ones) / n, 0.25, 4 * 0.4331 / std::sqrt(n));
}

}  // namespace
}  // namespace laterna
