// Rows of light: antialiasing beside covered areas, and rows that do not depend on how they are asked for.
#include "render/light_rows.h"

#include "render/replay.h"
#include "tests/render/rig.h"
#include "tests/testing.h"

#include <fmt/format.h>

#include <numbers>
#include <tuple>

namespace laterna {
namespace {

using testing::device_at;
using testing::object_of;
using testing::scene_of;
using testing::Traced;

TEST(SampleOffset, FillsEachCellOnceAndIsTheCentreForOne) {
  EXPECT_EQ(sample_offset_px({1, 5}, 0, {3, 4}, 0), glm::vec2(0, 0));
  for (const auto& [count, columns, rows] :
       {std::tuple{16, 4, 4}, std::tuple{2, 2, 1}, std::tuple{6, 3, 2}, std::tuple{7, 7, 1}}) {
    std::vector<int> cells(count, 0);
    for (int s = 0; s < count; ++s) {
      const glm::vec2 offset = sample_offset_px({count, 5}, 0, {3, 4}, s);
      ASSERT_GE(std::min(offset.x, offset.y), -0.5f);
      ASSERT_LT(std::max(offset.x, offset.y), 0.5f);
      ++cells[int((offset.y + 0.5f) * float(rows)) * columns + int((offset.x + 0.5f) * float(columns))];
    }
    EXPECT_EQ(cells, std::vector<int>(count, 1));
  }
  EXPECT_NE(sample_offset_px({16, 5}, 0, {3, 4}, 0), sample_offset_px({16, 6}, 0, {3, 4}, 0));
  EXPECT_NE(sample_offset_px({16, 5}, 0, {3, 4}, 0), sample_offset_px({16, 5}, 1, {3, 4}, 0));
}

TEST(TraceRows, OneSampleIsTheMapsOwnLight) {
  Scene scene =
      scene_of({object_of(relief(2, 2, 0.3, 40, 40))}, device_at({0.3, 0, 3}, {0, 0, 0}, {130, 90}, 150),
               device_at({-0.3, 0, 3}, {0, 0, 0}, {60, 40}, 60));
  scene.ambient_lx = 7;
  const Traced traced(scene);
  const CameraRays directions(scene.cameras[0].device);
  LightRows rows;
  rows.region = {64, 48, 66, 42};
  trace_rows(traced.rays, scene, 0, directions, 0)(rows);
  int lit = 0;
  for (int p = 0; p < 66 * 42; ++p) {
    const std::size_t i = traced.surface.albedo.index(64 + p % 66, 48 + p / 66);
    ASSERT_EQ(rows.begin[p + 1] - rows.begin[p], traced.light.lit(i) ? 1u : 0u);
    EXPECT_EQ(rows.ambient_cd_per_m2[p], luminance_cd_per_m2(traced.surface.albedo.values[i], 0, 7));
    if (!traced.light.lit(i)) continue;
    ++lit;
    const LightEntry& entry = rows.entries[rows.begin[p]];
    EXPECT_EQ(entry.u_px, traced.light.u_px.values[i]);
    EXPECT_EQ(entry.v_px, traced.light.v_px.values[i]);
    EXPECT_EQ(entry.weight,
              luminance_cd_per_m2(traced.surface.albedo.values[i], traced.light.white_lx.values[i], 0));
  }
  EXPECT_GT(lit, 500);
}

// A plane that faces the camera and ends at x = edge: 1 where the pixel lies inside, else 0.
Scene half_plane(double edge_px) {
  const double width = 4, edge_x = (edge_px - 39.5) / 100 * 2;  // 80 px, f = 100, at 2 m
  return scene_of({object_of(plane(width, 4), {edge_x - width / 2, 0, 0})},
                  device_at({0, 0, 2}, {0, 0, 0}, {80, 60}, 100), device_at({0, 0, 2}, {0, 0, 0}, {8, 8}, 3));
}

TEST(TraceRows, GreyAtAnEdgeIsTheCoveredArea) {
  for (const double edge_px : {41.3, 30.0, 52.75}) {
    const Scene scene = half_plane(edge_px);
    const RayScene rays(scene);
    const CameraRays directions(scene.cameras[0].device);
    const int column = int(std::floor(edge_px + 0.5));
    const double covered = edge_px + 0.5 - column;
    const ImageRows image{{80, 60}, trace_rows(rays, scene, 0, directions, 0, {16, testing::seed()})};
    const PatternStack white = testing::constant_pattern({8, 8}, 1, 255);
    const ImageStack<float> picture = play_luminance(image, Lookup::nearest, white);
    double inside = 0, mean = 0;
    for (int y = 0; y < 60; ++y) {
      inside += picture.values[y * 80 + column - 2] / 60;
      mean += picture.values[y * 80 + column] / 60;
      // Of 4 columns of cells only the one that the edge cuts is uncertain: 4 samples of 16.
      EXPECT_NEAR(picture.values[y * 80 + column] / picture.values[y * 80 + column - 2], covered, 0.251);
      EXPECT_EQ(picture.values[y * 80 + column + 1], 0);
    }
    // 240 samples of the cut cells, each at most 1/2 off in sigma, worth 1/4 of the pixel: 0.25·0.5/√240 =
    // 0.008; five of these.
    EXPECT_NEAR(mean / inside, covered, 0.04) << edge_px;
  }
}

TEST(TraceRows, TheMeanOverAPlaneDoesNotChange) {
  Scene scene = scene_of({object_of(plane(9, 9))}, device_at({0, 0, 2}, {0.2, 0, 0}, {64, 48}, 100),
                         device_at({-0.4, 0, 2}, {0, 0, 0}, {40, 40}, 30));
  scene.ambient_lx = 3;
  const RayScene rays(scene);
  const CameraRays directions(scene.cameras[0].device);
  const PatternStack white = testing::constant_pattern({40, 40}, 1, 255);
  double mean[2];
  for (const int count : {1, 16}) {
    const ImageRows image{{64, 48}, trace_rows(rays, scene, 0, directions, 0, {count, 3})};
    const auto picture = play_luminance(image, Lookup::nearest, white);
    mean[count == 16] = 0;
    for (const float value : picture.values) mean[count == 16] += value / 64 / 48;
  }
  // A smooth brightness has a mean over a pixel that differs from its centre's by its curvature only, ~1e-5
  // here.
  EXPECT_NEAR(mean[1] / mean[0], 1, 1e-4);
}

TEST(TraceRows, DistortedSamplesLieWhereTheLensPutsThem) {
  Device camera = device_at({0, 0, 2}, {0, 0, 0}, {64, 48}, 60);
  camera.lens = {"LENSMODEL_OPENCV4", {-0.05, 0.02, 0.001, -0.001}};
  const CameraRays directions(camera);
  const LensProjection lens(camera.intrinsics, camera.lens);
  for (const glm::ivec2 pixel : {glm::ivec2(0, 0), glm::ivec2(31, 20), glm::ivec2(63, 47)}) {
    const glm::dvec2 offset(0.4, -0.3);
    const glm::dvec2 there = *lens.project({directions.direction(pixel.x, pixel.y, offset), 1.0});
    // Pixels are coarse here, 1/60: curvature moves a sample by up to 1e-3 px, more where one neighbour is
    // lacking.
    EXPECT_LT(glm::length(there - (glm::dvec2(pixel) + offset)), 5e-3);
  }
}

TEST(TraceRows, RefusesAbsurdCounts) {
  const Scene scene = half_plane(40);
  const RayScene rays(scene);
  const CameraRays directions(scene.cameras[0].device);
  for (const int count : {0, -3, 4097})
    EXPECT_EQ(testing::input_error([&] {
                trace_rows(rays, scene, 0, directions, 0, {count, 0});
              }),
              fmt::format("samples per pixel: {} was found, expected a whole number from 1 to 4096", count));
}

}  // namespace
}  // namespace laterna
