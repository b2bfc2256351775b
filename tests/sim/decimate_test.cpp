#include "sim/decimate.h"

#include "sim/shapes.h"
#include "tests/testing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

namespace laterna {
namespace {

std::set<std::tuple<double, double, double>> positions_of(const Mesh& mesh) {
  std::set<std::tuple<double, double, double>> positions;
  for (const glm::dvec3& x : mesh.positions) positions.insert({x.x, x.y, x.z});
  return positions;
}

TEST(Decimate, WeldingMakesEqualPositionsOneVertexByHand) {
  Mesh two;  // two triangles that share an edge, each with vertices of its own, and one vertex that none has
  two.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  two.triangles = {{0, 1, 2}, {4, 5, 6}};
  two.texture_coordinates.resize(7);
  const Mesh one = welded(two);
  EXPECT_EQ(one.positions, (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  EXPECT_EQ(one.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_TRUE(one.texture_coordinates.empty());
}

TEST(Decimate, AReliefKeepsItsShareAndItsVertices) {
  const Mesh relief = welded(make_shape({"relief", {1.6, 1.0, 0.7}, 64, 7}));
  for (const double keep : {0.5, 0.1, 0.02}) {
    const Mesh few = decimated(relief, keep);
    const double share = double(few.triangles.size()) / double(relief.triangles.size());
    EXPECT_LE(share, keep);
    EXPECT_GE(share, 0.8 * keep);  // a collapse takes two triangles, so the count is nearly met
    const auto before = positions_of(relief), after = positions_of(few);
    EXPECT_TRUE(std::includes(before.begin(), before.end(), after.begin(), after.end()));
  }
}

TEST(Decimate, APlaneLosesNothing) {
  const Mesh few = decimated(welded(make_shape({"plane", {2, 1, 1}, 32, 1})), 0.01);
  EXPECT_LE(few.triangles.size(), 20u);  // of 2048
  double area = 0;
  for (const glm::uvec3& t : few.triangles) {
    const glm::dvec3 cross =
        glm::cross(few.positions[t.y] - few.positions[t.x], few.positions[t.z] - few.positions[t.x]);
    EXPECT_GE(cross.z, 0);  // towards +z still; slivers of no area may be left
    area += cross.z / 2;
  }
  EXPECT_NEAR(area, 2, 1e-12);
}

TEST(Decimate, FarFromTheOriginItIsTheSameChoice) {
  const Mesh near = welded(make_shape({"relief", {1.6, 1.0, 0.7}, 32, 7}));
  Mesh far = near;
  for (glm::dvec3& x : far.positions) x += glm::dvec3(1 << 20);  // floats of these would lose 6 cm
  EXPECT_NEAR(double(decimated(far, 0.2).triangles.size()), double(decimated(near, 0.2).triangles.size()), 4);
}

TEST(Decimate, KeepingAllChangesNothing) {
  const Mesh box = welded(make_shape({"box", {1, 1, 1}, 1, 1}));
  EXPECT_EQ(decimated(box, 1).triangles.size(), box.triangles.size());
  EXPECT_FALSE(decimated(box, 1e-9).triangles.empty());  // never nothing
}

}  // namespace
}  // namespace laterna
