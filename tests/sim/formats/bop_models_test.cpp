#include "sim/formats/bop_models.h"

#include "sim/formats/tree.h"
#include "sim/ply.h"
#include "sim/text_file.h"
#include "tests/testing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laterna {
namespace {

// A right angle of 3 and 4 metres in the plane z = 1, seen from above.
Mesh corner() { return {{{1, 2, 1}, {4, 2, 1}, {1, 6, 1}}, {{0, 1, 2}}, {}}; }

TEST(BopModels, AreInMillimetresWithTheirBoxAndDiameter) {
  const testing::ScratchFolder scratch;
  write_bop_models(scratch.path(), {{7, corner()}});
  const Tree info = Tree::parse(read_text(scratch / "models" / "models_info.json", 4096));
  ASSERT_EQ(info.size(), 1u);
  const Tree& seven = info.at("7");
  EXPECT_EQ(seven.at("diameter"), 5000.0);
  EXPECT_EQ(seven.at("min_x"), 1000.0);
  EXPECT_EQ(seven.at("min_y"), 2000.0);
  EXPECT_EQ(seven.at("min_z"), 1000.0);
  EXPECT_EQ(seven.at("size_x"), 3000.0);
  EXPECT_EQ(seven.at("size_y"), 4000.0);
  EXPECT_EQ(seven.at("size_z"), 0.0);
  const std::string ply = read_text(scratch / "models" / "obj_000007.ply", 4096);
  EXPECT_NE(ply.find("end_header\n1000 2000 1000 0 0 1\n"), ply.npos);
  const Mesh read = read_ply(ply, "obj_000007.ply");
  EXPECT_EQ(read.positions[2], glm::dvec3(1000, 6000, 1000));
  EXPECT_EQ(read.triangles, corner().triangles);
}

TEST(BopModels, LargestDistanceIsThatOfAllPairs) {
  auto random = testing::generator();
  std::normal_distribution<double> normal;
  for (int round = 0; round < 20; ++round) {
    std::vector<glm::dvec3> points;
    for (int i = 0; i < 60; ++i)
      points.push_back(glm::dvec3(normal(random), 0.2 * normal(random), normal(random) + 5));
    double largest = 0;
    for (const glm::dvec3& a : points)
      for (const glm::dvec3& b : points) largest = std::max(largest, glm::length(a - b));
    EXPECT_NEAR(largest_distance(points), largest,
                1e-14);  // a few roundings: of differences from the centroid
  }
  EXPECT_EQ(largest_distance({{1, 2, 3}}), 0);
}

}  // namespace
}  // namespace laterna
