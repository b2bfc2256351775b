#include "sim/rigid.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

#include <numbers>

namespace laterna {
namespace {

Rigid random_rigid(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto vector = [&] { return glm::dvec3(normal(random), normal(random), normal(random)); };
  return rigid_from_rotation_vector(vector(), vector());
}

double difference(const Rigid& a, const Rigid& b) {
  double worst = glm::length(a.translation - b.translation);
  for (int c = 0; c < 3; ++c) worst = std::max(worst, glm::length(a.rotation[c] - b.rotation[c]));
  return worst;
}

TEST(Rigid, RowsByHand) {
  const Rigid turned = rigid_from_rows({{{0, -1, 0, 5}, {1, 0, 0, 6}, {0, 0, 1, 7}}}, "m");
  EXPECT_EQ(apply(turned, {1, 0, 0}), glm::dvec3(5, 7, 7));  // x goes to y
  EXPECT_EQ(rows_of(turned)[0][1], -1);
  EXPECT_EQ(rows_of(turned)[1][3], 6);
}

TEST(Rigid, ComposeAndInverseAreLaws) {
  auto random = testing::generator();
  for (int i = 0; i < 100; ++i) {
    const Rigid a = random_rigid(random), b = random_rigid(random);
    const glm::dvec3 x(1, -2, 3);
    EXPECT_NEAR(glm::length(apply(compose(a, b), x) - apply(a, apply(b, x))), 0,
                1e-14);  // sizes near 10: some eps
    EXPECT_LE(difference(compose(a, inverse(a)), Rigid{}), 1e-14);
    EXPECT_NEAR(glm::length(apply(a, center_in_world(a))), 0, 1e-14);
  }
}

TEST(Rigid, RotationVectorRoundTrip) {
  auto random = testing::generator();
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const double angle =
        i < 100 ? std::numbers::pi * (1 - std::pow(10, -i / 8.0)) : std::pow(10, -(i - 100) / 8.0);
    const glm::dvec3 w = angle * glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)));
    const glm::dvec3 back = rotation_vector_rad(rigid_from_rotation_vector(w, glm::dvec3(0.0)).rotation);
    EXPECT_NEAR(glm::length(back - w), 0, 1e-12) << angle;  // near π the axis is known to some 10 eps
  }
  EXPECT_EQ(rotation_vector_rad(glm::dmat3(1.0)), glm::dvec3(0.0));
}

TEST(Rigid, QuaternionByHand) {
  const double h = std::sqrt(0.5);
  const Rigid quarter =
      rigid_from_quaternion(glm::dquat(2 * h, 0, 0, 2 * h), {0, 0, 0});  // 90° about z, not normalised
  EXPECT_NEAR(glm::length(apply(quarter, {1, 0, 0}) - glm::dvec3(0, 1, 0)), 0, 1e-15);  // one rounding
}

TEST(Rigid, LookAtByHand) {
  // Standing at x = 2 and looking at the origin with z up: z_device = -x, x_device = y (right hand), y_device
  // = -z.
  const Rigid m = device_from_world_looking_at({2, 0, 0}, {0, 0, 0}, {0, 0, 1});
  EXPECT_NEAR(glm::length(apply(m, {0, 0, 0}) - glm::dvec3(0, 0, 2)), 0, 1e-15);
  EXPECT_NEAR(glm::length(apply(m, {0, 0, 1}) - glm::dvec3(0, -1, 2)), 0, 1e-15);
  EXPECT_NEAR(glm::length(apply(m, {0, 1, 0}) - glm::dvec3(1, 0, 2)), 0, 1e-15);
  EXPECT_NEAR(glm::determinant(m.rotation), 1, 1e-15);
}

TEST(Rigid, RefusesWhatIsNoRigidMotion) {
  const auto rows = [](double a, double b) {
    return std::array<std::array<double, 4>, 3>{{{a, 0, 0, 0}, {0, b, 0, 0}, {0, 0, 1, 0}}};
  };
  const auto message = [&](double a, double b) {
    return testing::input_error([&] { rigid_from_rows(rows(a, b), "device_from_world"); });
  };
  EXPECT_THAT(message(1.01, 1), ::testing::HasSubstr("device_from_world: the left 3×3 block is no rotation"));
  EXPECT_THAT(message(-1, 1), ::testing::HasSubstr("reflection"));
  EXPECT_THAT(message(std::nan(""), 1), ::testing::HasSubstr("nan"));
  EXPECT_THAT(testing::input_error([] {
                device_from_world_looking_at({1, 1, 1}, {1, 1, 1}, {0, 0, 1});
              }),
              ::testing::HasSubstr("the position itself"));
  EXPECT_THAT(testing::input_error([] {
                device_from_world_looking_at({0, 0, 0}, {0, 0, 5}, {0, 0, 1});
              }),
              ::testing::HasSubstr("parallel"));
  EXPECT_THAT(testing::input_error([] { rigid_from_quaternion(glm::dquat(0, 0, 0, 0), {}); }),
              ::testing::HasSubstr("length is 0"));
}

}  // namespace
}  // namespace laterna
