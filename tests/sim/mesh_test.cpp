#include "sim/mesh.h"

#include "tests/testing.h"

#include <limits>

namespace laterna {
namespace {

using testing::input_error;

Mesh triangle() { return {{{0, 0, 0}, {2, 0, 0}, {0, 3, 1}}, {{0, 1, 2}}, {}}; }

std::string refusal(const Mesh& mesh) {
  return input_error([&] { validate(mesh, "house.ply"); });
}

TEST(Mesh, AcceptsATriangleAndCountsDegenerateOnes) {
  Mesh mesh = triangle();
  EXPECT_EQ(validate(mesh, "house.ply").degenerate_triangles, 0U);
  mesh.triangles.emplace_back(0, 1, 1);
  mesh.positions.emplace_back(4, 0, 0);
  mesh.triangles.emplace_back(0, 1, 3);  // on one line
  EXPECT_EQ(validate(mesh, "house.ply").degenerate_triangles, 2U);
}

TEST(Mesh, BoundsAreThoseOfTheVerticesInUse) {
  Mesh mesh = triangle();
  mesh.positions.emplace_back(100, 100, 100);
  const Box box = bounds(mesh);
  EXPECT_EQ(box.low, glm::dvec3(0, 0, 0));
  EXPECT_EQ(box.high, glm::dvec3(2, 3, 1));
}

TEST(Mesh, RefusesAnEmptyMesh) {
  EXPECT_EQ(refusal({}), "house.ply: the mesh has no vertices, expected at least three");
  EXPECT_EQ(refusal({{{0, 0, 0}}, {}, {}}), "house.ply: the mesh has no triangles, expected at least one");
}

TEST(Mesh, RefusesCoordinatesThatAreNotFinite) {
  Mesh mesh = triangle();
  mesh.positions[1].z = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(mesh), "house.ply: vertex 1 holds nan, expected finite coordinates");
  mesh.positions[1].z = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(mesh), "house.ply: vertex 1 holds an infinity, expected finite coordinates");
  mesh = triangle();
  mesh.texture_coordinates = {{0, 0}, {0, 0}, {0, std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_EQ(refusal(mesh), "house.ply: vertex 2 holds nan, expected finite texture coordinates");
}

TEST(Mesh, RefusesAnIndexOutOfRange) {
  Mesh mesh = triangle();
  mesh.triangles.emplace_back(0, 1, 3);
  EXPECT_EQ(refusal(mesh), "house.ply: triangle 1 uses vertex 3, expected 0 to 2");
}

TEST(Mesh, RefusesTextureCoordinatesOfAnotherCount) {
  Mesh mesh = triangle();
  mesh.texture_coordinates = {{0, 0}};
  EXPECT_EQ(refusal(mesh), "house.ply: 1 texture coordinates for 3 vertices, expected one each or none");
}

TEST(Mesh, RefusesDegenerateTrianglesOnly) {
  Mesh mesh = triangle();
  mesh.triangles = {{0, 1, 1}, {2, 2, 2}};
  EXPECT_EQ(refusal(mesh), "house.ply: each of its 2 triangles has zero area, expected a surface");
}

}  // namespace
}  // namespace laterna
