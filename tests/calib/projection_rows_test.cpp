#include "calib/projection_rows.h"

#include "sim/instruction_sets.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <random>

namespace laterna {
namespace {

struct Rows {
  std::size_t points, columns;
  std::vector<double> values;
  double operator()(std::size_t point, int row, std::size_t column) const {
    return values[column * 2 * points + row * points + point];
  }
};

// 131 points, so that a group of 128 and single ones are both met, some two units before the device.
PointTable random_points(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-0.7, 0.7);
  Correspondences c;
  for (int i = 0; i < 131; ++i) {
    c.world_points.emplace_back(uniform(random), uniform(random), uniform(random));
    c.projector_pixels.emplace_back(600 + 400 * uniform(random), 400 + 300 * uniform(random));
    c.sigma_px.push_back(0.5 + 0.3 * uniform(random));
  }
  return point_table(c, {});
}

ProjectorState state_with(std::vector<double> lens_parameters) {
  ProjectorState state{{1500, 1480, 630, 410}, rigid_from_rotation_vector({0.1, -0.2, 0.3}, {0.1, -0.05, 2})};
  state.parameters.insert(state.parameters.end(), lens_parameters.begin(), lens_parameters.end());
  return state;
}

Rows rows_of(const PointTable& points, const LensGradient& lens, const ProjectorState& state) {
  Rows rows{points.size(), std::size_t(lens.parameter_count() + 7), {}};
  rows.values.assign(2 * rows.points * rows.columns, 0.0);
  EXPECT_TRUE(fill_rows(points, lens, state, {}, 0, points.size(),
                        {rows.values.data(), 2 * rows.points, rows.points}));
  return rows;
}

struct KernelOfLens : ::testing::TestWithParam<std::pair<std::string, std::vector<double>>> {};

// The kernels' rows are mrcal's gradients, weighed; 1e-11 of a column's largest: a few dozen roundings.
TEST_P(KernelOfLens, WritesTheRowsThatMrcalsGradientsGive) {
  std::mt19937_64 random = testing::generator();
  const PointTable points = random_points(random);
  const LensGradient lens(GetParam().first);
  const ProjectorState state = state_with(GetParam().second);
  const Rows rows = rows_of(points, lens, state);
  const int p = lens.parameter_count() + 6;
  for (std::size_t i = 0; i < points.size(); ++i) {
    double pixel[2];
    std::vector<double> expected(2 * p);
    ASSERT_TRUE(
        project_with_rows(lens, state, {points.x[i], points.y[i], points.z[i]}, pixel, expected.data()));
    const double measured[2] = {points.u[i], points.v[i]}, w = points.inverse_sigma[i];
    for (int r = 0; r < 2; ++r) {
      EXPECT_NEAR(rows(i, r, p), w * (pixel[r] - measured[r]), 1e-10);
      for (int j = 0; j < p; ++j) {
        const double e = w * expected[r * p + j];
        EXPECT_NEAR(rows(i, r, j), e, 1e-11 * std::max(1.0, std::abs(e)))
            << "point " << i << ", column " << j;
      }
    }
  }
}

// The sum of squares is that of the rows' last column, to rounding.
TEST_P(KernelOfLens, SquaresTheSameResiduals) {
  std::mt19937_64 random = testing::generator();
  const PointTable points = random_points(random);
  const LensGradient lens(GetParam().first);
  const ProjectorState state = state_with(GetParam().second);
  const Rows rows = rows_of(points, lens, state);
  const auto s = squared_residuals(points, lens, state);
  ASSERT_TRUE(s);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double du = rows(i, 0, rows.columns - 1), dv = rows(i, 1, rows.columns - 1);
    EXPECT_NEAR((*s)[i], du * du + dv * dv, 1e-12 * (*s)[i]);
  }
}

// Without fused multiply-add, and with one order of every sum, rows are the same on every machine.
TEST_P(KernelOfLens, GivesTheSameBitsFromEachInstructionSet) {
  std::mt19937_64 random = testing::generator();
  const PointTable points = random_points(random);
  const LensGradient lens(GetParam().first);
  const ProjectorState state = state_with(GetParam().second);
  const Rows rows = rows_of(points, lens, state);
  const testing::CapLifter lifter;
  const std::vector<std::string> names = testing::instruction_sets_here();
  ASSERT_GE(names.size(), 2u);
  for (const std::string& name : names) {
    cap_instruction_set(name);
    EXPECT_EQ(rows_of(points, lens, state).values, rows.values) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Lenses, KernelOfLens,
    ::testing::Values(std::pair<std::string, std::vector<double>>("LENSMODEL_PINHOLE", {}),
                      std::pair<std::string, std::vector<double>>("LENSMODEL_OPENCV4",
                                                                  {-0.21, 0.13, 0.004, -0.007}),
                      std::pair<std::string, std::vector<double>>("LENSMODEL_OPENCV4", {0, 0, 0, 0}),
                      std::pair<std::string, std::vector<double>>("LENSMODEL_OPENCV5",
                                                                  {-0.21, 0.13, 0.004, -0.007, 0.05})));

TEST(ProjectionRows, APointBehindHasNoRows) {
  const LensGradient lens("LENSMODEL_OPENCV4");
  Correspondences c;
  c.world_points = {{0, 0, 1}, {0, 0, -3}};
  c.projector_pixels = {{0, 0}, {0, 0}};
  c.sigma_px = {1, 1};
  const ProjectorState state = state_with({-0.1, 0, 0, 0});
  EXPECT_FALSE(squared_residuals(point_table(c, {}), lens, state));
  EXPECT_FALSE(row_factor(point_table(c, {}), lens, state, {}));
}

}  // namespace
}  // namespace laterna
