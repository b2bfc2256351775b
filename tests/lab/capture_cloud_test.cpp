#include "apps/lab/capture_cloud.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

TEST(CaptureCloud, MidpointOfRaysByHand) {
  // Along x at height 0, and along y at height 1 over x = 3: closest at (3, 0, 0) and (3, 0, 1).
  Midpoint m;
  ASSERT_TRUE(midpoint({0, 0, 0}, {1, 0, 0}, {3, -5, 1}, {0, 1, 0}, m));
  EXPECT_EQ(m.x, glm::dvec3(3, 0, 0.5));
  EXPECT_EQ(m.gap_m, 1);
  EXPECT_EQ(m.along_a, 3);
  EXPECT_EQ(m.along_b, 5);
  EXPECT_FALSE(midpoint({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, m));
}

}  // namespace
}  // namespace laterna
