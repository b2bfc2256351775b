#include "render/surface_query.h"

#include "tests/testing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace laterna {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(SurfaceQuery, DistanceToATriangleByHand) {
  const glm::dvec3 a(0, 0, 0), b(4, 0, 0), c(0, 3, 0);
  EXPECT_EQ(distance_to_triangle({1, 1, -2}, a, b, c), 2);                 // above its inside
  EXPECT_EQ(distance_to_triangle({2, -3, 4}, a, b, c), 5);                 // beside an edge
  EXPECT_EQ(distance_to_triangle({-2, -3, 6}, a, b, c), 7);                // beyond a corner
  EXPECT_EQ(distance_to_triangle({1, 2, 0}, a, {2, 0, 0}, {4, 0, 0}), 2);  // degenerate: a line
  EXPECT_EQ(distance_to_triangle({3, 4, 0}, a, a, a), 5);                  // degenerate: a point
}

// Triangles at random, far from the origin, in a mesh that its object turns, scales and moves.
struct RandomScene {
  RandomScene() {
    auto random = testing::generator();
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto point = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
    Object object;
    object.name = "cloud";
    object.world_from_object = {{2, 0, 0, 0}, {0, 0, 2, 0}, {0, -2, 0, 0}, {1000, -500, 20, 1}};
    for (unsigned t = 0; t < 200; ++t) {
      const glm::dvec3 middle = point();
      for (int k = 0; k < 3; ++k) object.mesh.positions.push_back(middle + 0.2 * point());
      object.mesh.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    }
    scene.objects = {object, object};
    scene.objects[1].world_from_object[3] = {1001, -500, 20, 1};
    for (int i = 0; i < 300; ++i) points.push_back(glm::dvec3(1000, -500, 20) + 4.0 * point());
  }
  double least(const glm::dvec3& x) const {
    double found = infinity;
    for (const Object& object : scene.objects) {
      const std::vector<glm::dvec3> v = world_positions(object);
      for (const glm::uvec3& t : object.mesh.triangles)
        found = std::min(found, distance_to_triangle(x, v[t.x], v[t.y], v[t.z]));
    }
    return found;
  }
  Scene scene;
  std::vector<glm::dvec3> points;
};

TEST(SurfaceQuery, TheNearestOfAllTrianglesIsFound) {
  const RandomScene random;
  const RayScene rays(random.scene);
  const SurfaceQuery query(rays, random.scene);
  for (const glm::dvec3& x : random.points) {
    const double expected = random.least(x);
    // Coordinates of 1000 round at 1e-13; a sum or two of them.
    EXPECT_NEAR(query.distance_m(x, infinity), expected, 1e-12);
    EXPECT_NEAR(query.distance_m(x, 0.5), std::min(0.5, expected), 1e-12);
  }
}

TEST(SurfaceQuery, RaysEndOnThePlanesTheyMeet) {
  Scene scene;
  Object object;
  object.name = "floor";
  object.mesh = {{{-1, -1, 3}, {1, -1, 3}, {0, 2, 3}}, {{0, 1, 2}}, {}};
  scene.objects = {object};
  const RayScene rays(scene);
  const SurfaceQuery query(rays, scene);
  std::vector<glm::dvec3> directions(19, glm::dvec3(0, 0, 1));  // more than one packet, the last not full
  directions[1] = {0.1, 0.2, 1};
  directions[2] = {0, 0, -1};
  directions[3] = glm::dvec3(std::nan(""));
  directions[18] = {-0.05, 0, 0.5};
  const std::vector<glm::dvec3> points = query.first_points({0, 0, 1}, directions);
  EXPECT_EQ(points[0], glm::dvec3(0, 0, 3));
  EXPECT_LT(glm::distance(points[1], {0.2, 0.4, 3}), 1e-15);  // a rounding of numbers below 4
  EXPECT_TRUE(std::isnan(points[2].x) && std::isnan(points[3].x));
  EXPECT_LT(glm::distance(points[18], {-0.2, 0, 3}), 1e-15);
}

}  // namespace
}  // namespace laterna
