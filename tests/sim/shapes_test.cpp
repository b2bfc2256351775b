#include "sim/shapes.h"

#include "sim/parallel.h"
#include "tests/sim/surface.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace laterna {
namespace {

using testing::area_vector;
using ::testing::HasSubstr;
using testing::input_error;
using testing::open_edges;
using testing::pictures_unmirrored;
using testing::volume;

double area(const Mesh& mesh) {
  double twice = 0;
  for (const glm::uvec3& t : mesh.triangles) twice += glm::length(area_vector(mesh, t));
  return twice / 2;
}

bool faces_up(const Mesh& mesh) {
  for (const glm::uvec3& t : mesh.triangles)
    if (area_vector(mesh, t).z <= 0) return false;
  return true;
}

TEST(Shapes, PlaneByHand) {
  const Mesh mesh = plane(4, 2, 2, 1);
  EXPECT_EQ(mesh.positions,
            std::vector<glm::dvec3>({{-2, -1, 0}, {0, -1, 0}, {2, -1, 0}, {-2, 1, 0}, {0, 1, 0}, {2, 1, 0}}));
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_EQ(mesh.texture_coordinates[1], glm::dvec2(0.5, 0));  // bottom edge, middle
  EXPECT_EQ(mesh.texture_coordinates[5], glm::dvec2(1, 1));    // upper right
  EXPECT_TRUE(faces_up(mesh));
  EXPECT_TRUE(pictures_unmirrored(mesh));
}

TEST(Shapes, BoxIsClosedWithFrontsOutOrIn) {
  for (const bool inward : {false, true}) {
    const Mesh mesh = box({2, 3, 4}, inward);
    EXPECT_EQ(mesh.triangles.size(), 12U);
    EXPECT_EQ(open_edges(mesh), 0);
    EXPECT_EQ(volume(mesh), inward ? -24.0 : 24.0);  // products of small integers: exact
    EXPECT_EQ(area(mesh), 52.0);
    EXPECT_EQ(bounds(mesh).high, glm::dvec3(1, 1.5, 2));
    EXPECT_EQ(bounds(mesh).low, glm::dvec3(-1, -1.5, -2));
    EXPECT_TRUE(pictures_unmirrored(mesh));
  }
}

TEST(Shapes, SphereIsClosedAndRound) {
  for (const int subdivisions : {1, 2, 7, 32}) {
    const Mesh mesh = sphere(2, subdivisions);
    EXPECT_EQ(open_edges(mesh), 0);
    EXPECT_EQ(validate(mesh, "sphere").degenerate_triangles, 0U);
    EXPECT_TRUE(pictures_unmirrored(mesh));
    for (const glm::dvec3& p : mesh.positions) EXPECT_NEAR(glm::length(p), 2, 2e-15);  // a few roundings of 2
  }
  EXPECT_EQ(sphere(1, 1).triangles.size(), 8U);
  EXPECT_NEAR(volume(sphere(1, 1)), 4.0 / 3, 1e-15);  // the octahedron, to rounding
}

TEST(Shapes, SphereVolumeNearsTheBallQuadratically) {
  const double ball = 4 * std::numbers::pi / 3;
  const double coarse = ball - volume(sphere(1, 31)), fine = ball - volume(sphere(1, 63));
  EXPECT_GT(fine, 0);
  EXPECT_NEAR(coarse / fine, 4,
              0.02);  // half the cell, a quarter of the error, up to the next order: 1/32² · 4
}

TEST(Shapes, ReliefFillsItsDepthAndRepeats) {
  const Mesh mesh = relief(2, 1, 0.3, 40, 20, 7);
  EXPECT_EQ(bounds(mesh).low, glm::dvec3(-1, -0.5, -0.15));
  EXPECT_EQ(bounds(mesh).high, glm::dvec3(1, 0.5, 0.15));
  EXPECT_TRUE(faces_up(mesh));
  EXPECT_EQ(relief(2, 1, 0.3, 40, 20, 7).positions, mesh.positions);
  EXPECT_NE(relief(2, 1, 0.3, 40, 20, 8).positions, mesh.positions);
  set_thread_count(1);
  EXPECT_EQ(relief(2, 1, 0.3, 40, 20, 7).positions, mesh.positions);
  set_thread_count(0);
}

TEST(Shapes, ReliefKeepsItsBitsOverTheYears) {
  const Mesh mesh = relief(2, 1, 0.3, 4, 2, 7);
  // Written down once. 1e-12: other mathematical libraries round cosines otherwise.
  EXPECT_NEAR(mesh.positions[3].z, 0.020105636485421151, 1e-12);
  EXPECT_NEAR(mesh.positions[8].z, 0.071730091796755255, 1e-12);
}

TEST(Shapes, ReliefIsSmoothWithBroadAndSmallFeatures) {
  const Mesh mesh = relief(1, 1, 0.2, 256, 256, 3);
  const auto z = [&](int column, int row) { return mesh.positions[std::size_t(row) * 257 + column].z; };
  double broad = 0, steepest = 0;
  int turns = 0;
  for (int row = 0; row <= 256; ++row) {
    for (int column = 1; column < 256; ++column) {
      steepest = std::max(steepest, std::abs(z(column + 1, row) - z(column, row)) * 256);
      turns += (z(column + 1, row) - z(column, row)) * (z(column, row) - z(column - 1, row)) < 0;
    }
    broad = std::max(broad, std::abs(z(256, row) - z(64, row)));
  }
  EXPECT_LT(steepest, 3);             // a slope that a projector still lights: below 72°
  EXPECT_GT(steepest, 0.2);           // not flat: more than its depth over its width
  EXPECT_GT(double(turns) / 257, 2);  // more bumps along a row than the longest waves alone make
  EXPECT_GT(broad, 0.05);             // a good part of the depth within three quarters of the width
}

TEST(Shapes, VGrooveHasItsOpening) {
  const Mesh mesh = v_groove(2, 3, 90);
  EXPECT_NEAR(bounds(mesh).high.z, 0.5, 1e-15);  // width/2 / tan 45° / 2, to rounding
  EXPECT_NEAR(bounds(mesh).low.z, -0.5, 1e-15);
  EXPECT_TRUE(faces_up(mesh));
  const glm::dvec3 left = glm::normalize(area_vector(mesh, mesh.triangles.front()));
  const glm::dvec3 right = glm::normalize(area_vector(mesh, mesh.triangles.back()));
  EXPECT_NEAR(glm::dot(left, right), 0, 1e-15);  // flanks at 90°
  EXPECT_GT(left.x, 0);                          // the left flank faces right: a groove, not a ridge
}

TEST(Shapes, MakeShapeKnowsEachByName) {
  EXPECT_EQ(make_shape({"plane", {4, 2, 1}, 3}).positions, plane(4, 2, 3, 3).positions);
  EXPECT_EQ(make_shape({"box", {4, 2, 1}}).positions, box({4, 2, 1}).positions);
  EXPECT_EQ(make_shape({"sphere", {4, 4, 4}, 5}).positions, sphere(2, 5).positions);
  EXPECT_EQ(make_shape({"relief", {4, 2, 1}, 3, 9}).positions, relief(4, 2, 1, 3, 3, 9).positions);
  const Box groove = bounds(make_shape({"v_groove", {4, 2, 0.7}}));
  EXPECT_NEAR(groove.high.z - groove.low.z, 0.7, 1e-15);  // the depth, through an angle and back
}

TEST(Shapes, EachShapeIsAValidMesh) {
  for (const char* name : {"plane", "box", "sphere", "relief", "v_groove"})
    for (const int detail : {1, 2, 64})
      EXPECT_EQ(validate(make_shape({name, {1, 1, 1}, detail}), name).degenerate_triangles, 0U)
          << name << detail;
}

TEST(Shapes, RefusesBadInput) {
  const auto refusal = [](const ShapeSpec& spec) { return input_error([&] { make_shape(spec); }); };
  EXPECT_EQ(refusal({"cone"}),
            "shape \"cone\" is not known, expected one of \"plane\", \"box\", \"sphere\", \"relief\", "
            "\"v_groove\"");
  EXPECT_EQ(refusal({"plane", {1, 1, 1}, 0}), "plane: the detail is 0, expected 1 to 4096");
  EXPECT_EQ(refusal({"relief", {1, 1, 1}, 4097}), "relief: the detail is 4097, expected 1 to 4096");
  EXPECT_EQ(refusal({"plane", {1, -2, 1}}), "plane: the height is -2, expected a finite length above 0");
  EXPECT_EQ(refusal({"relief", {1, 1, 0}}), "relief: the depth is 0, expected a finite length above 0");
  EXPECT_EQ(refusal({"sphere", {1, 2, 1}}), "sphere: the size is [1, 2, 1], expected three equal diameters");
  EXPECT_THAT(refusal({"box", {1, 1, std::numeric_limits<double>::quiet_NaN()}}), HasSubstr("a side is nan"));
  EXPECT_THAT(refusal({"v_groove", {1, 1, std::numeric_limits<double>::infinity()}}),
              HasSubstr("the depth is inf"));
  EXPECT_EQ(input_error([] { v_groove(1, 1, 180); }),
            "v_groove: the opening is 180°, expected above 0 and below 180");
}

}  // namespace
}  // namespace laterna
