#include "render/effects/displacement.h"

#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>

namespace laterna {
namespace {

using testing::Lit;

std::shared_ptr<const Image<float>> heights(int width, int height, float value) {
  return std::make_shared<const Image<float>>(width, height, value);
}

void displace(Object& object, double amplitude, std::shared_ptr<const Image<float>> map, double edge_px = 1) {
  object.displacement_map = std::move(map);
  object.effects.displacement_map = "heights.png";
  object.effects.displacement = amplitude;
  object.effects.displacement_edge_px = edge_px;
}

TEST(Displacement, MovesAPlaneByAConstantExactly) {
  Scene scene = testing::facing_plane();
  Scene moved_by_hand = scene;
  moved_by_hand.objects[0].world_from_object =
      glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, 0.25)) * scene.objects[0].world_from_object;
  displace(scene.objects[0], 0.5, heights(8, 4, 0.5f));
  scene.effects.displacement = true;
  std::optional<Scene> storage;
  const Scene& moved = displaced(scene, storage);
  ASSERT_TRUE(storage);
  EXPECT_GE(moved.objects[0].mesh.triangles.size(), 2u * 8 * 4);
  for (const glm::dvec3& x : moved.objects[0].mesh.positions)
    EXPECT_EQ(x.z, 0.25);  // 0.5·0.5, exact in binary
  const Lit found(moved), expected(moved_by_hand);
  for (std::size_t p = 0; p < found.size(); ++p) {
    // A few roundings of a double at 2 m, and of the float lux.
    EXPECT_NEAR(found.surface.depth_m.values[p], 1.75, 1e-14);
    EXPECT_NEAR(found.light().white_lx.values[p], expected.light().white_lx.values[p], 1e-3);
  }
}

/// How many pixels of the camera see anything.
int seen(const Scene& scene) {
  std::optional<Scene> storage;
  const Scene& moved = displaced(scene, storage);
  const RayScene rays(moved);
  const SurfaceMap surface = trace_surface(rays, moved, moved.cameras[0]);
  int count = 0;
  for (std::size_t p = 0; p < surface.depth_m.values.size(); ++p) count += surface.hit(p);
  return count;
}

TEST(Displacement, ASpheresSilhouetteGrowsByTheClosedFormAngleANormalMapsDoesNot) {
  constexpr double radius = 0.3, distance = 2, focal_px = 400;
  Scene scene =
      testing::scene_of({testing::object_of(sphere(radius, 95))},
                        testing::device_at({0, -distance, 0}, {0, 0, 0}, {200, 200}, focal_px, {0, 0, 1}),
                        testing::device_at({1, -distance, 0}, {0, 0, 0}, {64, 48}, 60, {0, 0, 1}));
  // A sphere's outline is a circle of radius f·tan(asin(r/d)) about the image's middle.
  const auto outline_px = [&](double r) { return focal_px * std::tan(std::asin(r / distance)); };
  const auto radius_px = [](int pixels) { return std::sqrt(pixels / 3.14159265358979); };
  const int plain = seen(scene);
  EXPECT_NEAR(radius_px(plain), outline_px(radius), 0.1);  // facets and counted pixels, as below
  scene.objects[0].normal_map = std::make_shared<const Image<glm::vec3>>(2, 2, glm::vec3(0.8f, 0.5f, 0.9f));
  scene.effects.normal_map = true;
  EXPECT_EQ(seen(scene), plain);
  scene.effects.displacement = true;
  for (const double amplitude : {0.1, -0.06}) {
    displace(scene.objects[0], amplitude, heights(256, 128, 0.5f));
    // 0.1: the outline of 1e2 px radius crosses some 6e2 pixels, each counted by its centre: σ of the area is
    // √600·0.3 px², of the radius 0.01; facets of 2° lie 1.5e-4·r inside.
    EXPECT_NEAR(radius_px(seen(scene)), outline_px(radius + 0.5 * amplitude), 0.1) << amplitude;
  }
}

TEST(Displacement, OffItLeavesNoTrace) {
  Scene scene = testing::facing_plane();
  const Lit plain(scene);
  displace(scene.objects[0], 0.5, heights(4, 4, 1));
  std::optional<Scene> storage;
  EXPECT_EQ(&displaced(scene, storage), &scene);
  scene.effects.displacement = true;
  scene.objects[0].displacement_map = nullptr;
  EXPECT_EQ(&displaced(scene, storage), &scene);
  EXPECT_FALSE(storage);
  const Lit off(scene);
  EXPECT_TRUE(testing::same_bits(off.surface.depth_m, plain.surface.depth_m));
  EXPECT_TRUE(testing::same_bits(off.light().white_lx, plain.light().white_lx));
}

/// Edges that bound one triangle only, by the positions of their ends.
int open_edges(const Mesh& mesh) {
  const auto key = [&](std::uint32_t i) {
    const glm::dvec3& x = mesh.positions[i];
    return std::array{x.x, x.y, x.z};
  };
  std::map<std::pair<std::array<double, 3>, std::array<double, 3>>, int> turns;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const auto a = key(t[i]), b = key(t[(i + 1) % 3]);
      if (a == b) continue;  // at a sphere's pole
      turns[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  return int(std::count_if(turns.begin(), turns.end(), [](const auto& edge) { return edge.second != 0; }));
}

TEST(Displacement, RefinesToTheEdgeLengthAndOpensNothing) {
  Object object = testing::object_of(relief(1, 0.7, 0.2, 5, 3));
  auto map = std::make_shared<Image<float>>(37, 23);
  auto random = testing::generator();
  for (float& h : map->values) h = float(random() % 1000) / 1000;
  displace(object, 0.05, map, 1.5);
  const Mesh mesh = displaced(object).mesh;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const glm::dvec2 edge = mesh.texture_coordinates[t[i]] - mesh.texture_coordinates[t[(i + 1) % 3]];
      EXPECT_LE(glm::length(edge * glm::dvec2(37, 23)), 1.5);
    }
  }
  // The outline alone is open: an inner edge would show a crack.
  double outline = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> turns;
  for (const glm::uvec3& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) ++turns[std::minmax(t[i], t[(i + 1) % 3])];
  for (const auto& [edge, count] : turns) {
    ASSERT_LE(count, 2);
    if (count == 1)
      outline += glm::length(mesh.texture_coordinates[edge.first] - mesh.texture_coordinates[edge.second]);
  }
  EXPECT_NEAR(outline, 4, 1e-12);  // of the unit square in (s, t)
  EXPECT_EQ(validate(mesh, "m").degenerate_triangles, 0u);
}

TEST(Displacement, KeepsASphereClosedAcrossItsSeam) {
  Object object = testing::object_of(sphere(1, 7));
  auto map = std::make_shared<Image<float>>(64, 32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x)  // periodic in s, constant towards the poles
      (*map)(x, y) = y < 4 || y > 27 ? 0.5f : float(0.5 + 0.4 * std::sin(x * 6.283185307 / 64));
  displace(object, 0.1, map);
  EXPECT_EQ(open_edges(object.mesh), 0);
  EXPECT_EQ(open_edges(displaced(object).mesh), 0);
}

TEST(Displacement, RefusesTooManyTriangles) {
  Object object = testing::object_of(plane(1, 1));
  displace(object, 0.1, heights(4096, 4096, 0.5f));
  EXPECT_THAT(testing::input_error([&] { displaced(object); }),
              ::testing::AllOf(::testing::HasSubstr("object: "), ::testing::HasSubstr("4096×4096"),
                               ::testing::HasSubstr("more than 4194304 triangles"),
                               ::testing::HasSubstr("expected a larger displacement_edge_px")));
  object.effects.displacement_edge_px = 64;
  EXPECT_LT(displaced(object).mesh.triangles.size(), 40000u);
}

}  // namespace
}  // namespace laterna
