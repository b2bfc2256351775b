#include "sim/rq.h"

#include "sim/rigid.h"
#include "tests/testing.h"

#include <gtest/gtest.h>

namespace laterna {
namespace {

// Columns, as GLM takes them.
glm::dmat3 k_matrix(double fx, double fy, double cx, double cy, double skew) {
  return {fx, 0.0, 0.0, skew, fy, 0.0, cx, cy, 1.0};
}

TEST(KAndR, OfUprightMatrixIsItself) {
  const KAndR parts = k_and_r(k_matrix(4, 3, 2, 1, 0.5), {8, 6});
  EXPECT_EQ(parts.intrinsics.size, glm::ivec2(8, 6));
  EXPECT_EQ(parts.intrinsics.fx, 4);
  EXPECT_EQ(parts.intrinsics.fy, 3);
  EXPECT_EQ(parts.intrinsics.cx, 2);
  EXPECT_EQ(parts.intrinsics.cy, 1);
  EXPECT_EQ(parts.skew_px, 0.5);
  EXPECT_EQ(parts.scale, 1);
  EXPECT_EQ(parts.rotation, glm::dmat3(1.0));
}

TEST(KAndR, TheirProductIsTheMatrixAtAnyScale) {
  auto random = testing::generator();
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&] { return uniform(random); };
  for (int i = 0; i < 100; ++i) {
    const glm::dmat3 k = k_matrix(800 + 300 * any(), 800 + 300 * any(), 900 * any(), 900 * any(), 50 * any());
    const glm::dmat3 r = rigid_from_rotation_vector({3 * any(), 3 * any(), 3 * any()}, {}).rotation;
    const double scale = i % 2 ? 0.3 + any() * 0.2 : -1e3 + any();
    const KAndR parts = k_and_r(scale * (k * r), {640, 480});
    const Intrinsics& f = parts.intrinsics;
    const glm::dmat3 product =
        parts.scale * (k_matrix(f.fx, f.fy, f.cx, f.cy, parts.skew_px) * parts.rotation);
    for (int c = 0; c < 3; ++c) {
      // Numbers up to 1e3 of double precision, each from some ten operations.
      EXPECT_LT(glm::length(product[c] / scale - (k * r)[c]), 1e-10);
      EXPECT_LT(glm::length(parts.rotation[c] - r[c]), 1e-12);
    }
    EXPECT_GT(f.fx, 0);
    EXPECT_GT(f.fy, 0);
  }
}

}  // namespace
}  // namespace laterna
