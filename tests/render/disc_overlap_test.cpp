// Areas of a disc within rectangles, beside halves, segments and sums.
#include "render/disc_overlap.h"

#include "tests/testing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace laterna {
namespace {

double share(double left, double right, double top, double bottom) {
  return disc_share(disc_edge(left), disc_edge(right), disc_edge(top), disc_edge(bottom));
}

TEST(DiscOverlap, HalvesQuartersAndTheInscribedSquare) {
  // Sums of a few numbers of order 1: 1e-15.
  EXPECT_NEAR(share(-1, 1, -1, 1), 1, 1e-15);
  EXPECT_NEAR(share(-9, 9, -9, 9), 1, 1e-15);
  EXPECT_NEAR(share(0, 5, -5, 5), 0.5, 1e-15);
  EXPECT_NEAR(share(-3, 0, 0, 3), 0.25, 1e-15);
  const double h = std::sqrt(0.5);
  EXPECT_NEAR(share(-h, h, -h, h), 2 / std::numbers::pi, 1e-15);
  EXPECT_NEAR(share(h, 2, -2, 2), (std::numbers::pi / 4 - 0.5) / std::numbers::pi, 1e-15);  // a segment
  EXPECT_EQ(share(0.8, 2, 0.8, 2), 0);  // a corner outside the disc
}

TEST(DiscOverlap, AgreesWithCounting) {
  auto generator = testing::generator();
  std::uniform_real_distribution<double> edge(-1.2, 1.2);
  for (int i = 0; i < 20; ++i) {
    const double x0 = edge(generator), x1 = edge(generator), y0 = edge(generator), y1 = edge(generator);
    constexpr int n = 400;
    int inside = 0;
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b < n; ++b) {
        const double x = (a + 0.5) / n * 2 - 1, y = (b + 0.5) / n * 2 - 1;
        inside += x * x + y * y <= 1 && x >= std::min(x0, x1) && x <= std::max(x0, x1) &&
                  y >= std::min(y0, y1) && y <= std::max(y0, y1);
      }
    }
    // Cells of the counting grid along the outline: at most 8 per column, half of them wrong: 0.01.
    EXPECT_NEAR(share(std::min(x0, x1), std::max(x0, x1), std::min(y0, y1), std::max(y0, y1)),
                inside * 4.0 / (n * n) / std::numbers::pi, 0.01);
  }
}

TEST(DiscOverlap, AGridOfCellsHoldsTheWholeDisc) {
  for (const double radius : {1e-6, 0.3, 1.75, 12.5}) {
    double sum = 0;
    for (int y = -14; y <= 14; ++y)
      for (int x = -14; x <= 14; ++x)
        sum += share((x - 0.5 - 0.4) / radius, (x + 0.5 - 0.4) / radius, (y - 0.5 + 0.3) / radius,
                     (y + 0.5 + 0.3) / radius);
    EXPECT_NEAR(sum, 1, 1e-12) << radius;  // 841 roundings
  }
}

}  // namespace
}  // namespace laterna
