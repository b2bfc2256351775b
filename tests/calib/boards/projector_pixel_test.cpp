#include "calib/boards/projector_pixel.h"

#include "calib/boards/sight_board.h"
#include "tests/testing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace laterna {

namespace {

using Mapping = std::function<glm::dvec2(const glm::dvec2&)>;

DecodedMap map_of(const Mapping& mapping, int width = 81, int height = 81) {
  DecodedMap map(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec2 p = mapping({x, y});
      map.u_px(x, y) = p.x, map.v_px(x, y) = p.y;
      map.sigma_px(x, y) = 0.3f, map.valid(x, y) = 1;
    }
  return map;
}

// A plane through two pinholes at a tilt of half its distance over 1000 px.
glm::dvec2 homography(const glm::dvec2& p) {
  return glm::dvec2(300 + 0.8 * p.x + 0.1 * p.y, 200 - 0.05 * p.x + 0.9 * p.y) /
         (1 + 3e-4 * p.x + 2e-4 * p.y);
}

// The same through a lens: k1 = -0.2 at a focal length of 800 px, far from the centre.
glm::dvec2 through_a_lens(const glm::dvec2& p) {
  const glm::dvec2 n = (homography(p) - glm::dvec2(-100, 600)) / 800.0;
  return glm::dvec2(-100, 600) + 800.0 * n * (1 - 0.2 * glm::dot(n, n));
}

}  // namespace

TEST(ProjectorPixel, AnAffineMapIsReadExactly) {
  const auto affine = [](const glm::dvec2& p) { return glm::dvec2(10 + 0.5 * p.x, 20 + 2 * p.y); };
  for (const LocalMap local : {LocalMap::homography, LocalMap::quadratic}) {
    const auto read = projector_pixel_at(map_of(affine), {40.3, 39.7}, {.map = local});
    ASSERT_TRUE(read);
    EXPECT_NEAR(read->pixel.x, 10 + 0.5 * 40.3, 1e-6);  // where OpenCV's refinement stops
    EXPECT_NEAR(read->pixel.y, 20 + 2 * 39.7, 1e-6);
    EXPECT_LT(read->residual_px, 1e-6);
  }
}

// Third-order terms of a disc of 12 px at 3e-4 per pixel: (12·3.6e-4)³·1000 px = 8e-5, odd about the centre.
TEST(ProjectorPixel, PerspectiveIsRespected) {
  for (const LocalMap local : {LocalMap::homography, LocalMap::quadratic}) {
    const auto read = projector_pixel_at(map_of(homography), {40.3, 39.7}, {.map = local});
    ASSERT_TRUE(read);
    EXPECT_LT(glm::distance(read->pixel, homography({40.3, 39.7})), 1e-4);
  }
}

// With a lens the quadratic stays, and the homography is off by its second-order terms.
TEST(ProjectorPixel, TheQuadraticRespectsLensesToo) {
  const glm::dvec2 at(40.3, 39.7);
  const DecodedMap map = map_of(through_a_lens);
  const auto quadratic = projector_pixel_at(map, at, {.radius_px = 35});
  const auto straight = projector_pixel_at(map, at, {.map = LocalMap::homography, .radius_px = 35});
  ASSERT_TRUE(quadratic && straight);
  const double error = glm::distance(quadratic->pixel, through_a_lens(at));
  EXPECT_LT(error, 2e-3);  // third order at 35 px of 800: k1·(35/800)³·800 px, mostly odd
  EXPECT_GT(glm::distance(straight->pixel, through_a_lens(at)), 3 * error);
}

// Rounded codes with a third of the pixels anywhere: what is left is 0.408 px over the root of the pixels,
// times 2 for the quadratic's share at the centre; ten times less than a pixel.
TEST(ProjectorPixel, OutliersAreLeftOutAndSigmaIsHonest) {
  auto random = testing::generator();
  std::uniform_real_distribution<double> anywhere(0, 1000), choice(0, 1);
  std::normal_distribution<double> normal(0, 0.3);
  double chi2 = 0;
  constexpr int trials = 60;
  for (int trial = 0; trial < trials; ++trial) {
    DecodedMap map = map_of(homography);
    for (std::size_t i = 0; i < map.valid.values.size(); ++i) {
      map.u_px.values[i] += normal(random), map.v_px.values[i] += normal(random);
      if (choice(random) < 0.3) map.u_px.values[i] = anywhere(random);
    }
    const auto read = projector_pixel_at(map, {40, 40}, {});
    ASSERT_TRUE(read);
    EXPECT_LT(glm::distance(read->pixel, homography({40, 40})), 0.15);
    EXPECT_LT(read->used, read->valid);
    const glm::dvec2 z = (read->pixel - homography({40, 40})) / read->sigma_px;
    chi2 += glm::dot(z, z);
  }
  // 120 degrees of freedom: mean 120, sigma 15.5; culling at three times the median shortens the residuals by
  // a few per cent, so five sigmas are allowed above and below.
  EXPECT_GT(chi2, 45);
  EXPECT_LT(chi2, 198);
}

TEST(ProjectorPixel, NoneWhereThereIsTooLittle) {
  DecodedMap map = map_of(homography);
  EXPECT_FALSE(projector_pixel_at(map, {-30, 40}));
  EXPECT_FALSE(projector_pixel_at(map, {40, 40}, {.radius_px = 4}));  // 49 pixels
  for (int y = 0; y < 81; ++y)
    for (int x = 0; x < 36; ++x) reject(map, std::size_t(y * 81 + x), Reject::dim);
  EXPECT_FALSE(projector_pixel_at(map, {36, 40}));  // all of them to the right of the point
  EXPECT_TRUE(projector_pixel_at(map, {46, 40}));
}

// Two points of a board, 20 px apart: read over 9 px each.
TEST(SightBoard, SightingsByHand) {
  const PrintedBoard board = parse_board("chessboard,3x3,10mm");
  std::vector<FoundPoint> found;
  for (int k = 0; k < 9; ++k) found.push_back({k, {20 + 20 * (k % 3), 20 + 20 * (k / 3)}});
  std::vector<Sighting> sightings;
  add_camera_sightings(found, board, 0, 4, sightings);
  const BoardReading reading =
      add_projector_sightings(found, board, map_of(homography), 1, 4, LocalMap::quadratic, sightings);
  ASSERT_EQ(sightings.size(), 18u);
  EXPECT_EQ(reading.points, 9u);
  EXPECT_LT(reading.median_residual_px, 1e-4);
  EXPECT_EQ(sightings[13].device, 1);
  EXPECT_EQ(sightings[13].pose, 4);
  EXPECT_EQ(sightings[13].corner, 4);
  EXPECT_DOUBLE_EQ(sightings[13].x_board.x, 0.01);
  EXPECT_LT(glm::distance(sightings[13].pixel, homography({40, 40})), 1e-4);
}

}  // namespace laterna
