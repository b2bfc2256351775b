#include "render/surface.h"

#include "sim/parallel.h"
#include "tests/render/rig.h"
#include "tests/testing.h"

#include <cstring>

namespace laterna {
namespace {

using testing::device_at;
using testing::object_of;
using testing::scene_of;

SurfaceMap trace(const Scene& scene) { return trace_surface(RayScene(scene), scene, scene.cameras[0]); }

// The world direction of pixel (x, y) of a pinhole, from scratch: right, down and forward of a camera that
// looks from `position` to `target` with y up.
struct PlainCamera {
  glm::dvec3 position, forward, right, down;
  double focal, cx, cy;

  PlainCamera(const glm::dvec3& from, const glm::dvec3& to, glm::ivec2 size, double focal_px)
      : position(from), focal(focal_px), cx((size.x - 1) / 2.0), cy((size.y - 1) / 2.0) {
    forward = (to - from) / glm::length(to - from);
    const glm::dvec3 side(-forward.z, 0, forward.x);  // forward × y
    right = side / glm::length(side);
    down = glm::cross(forward, right);
  }
  glm::dvec3 ray(double x, double y) const {
    return forward + (x - cx) / focal * right + (y - cy) / focal * down;
  }
};

TEST(TraceSurface, ATiltedScaledPlaneInClosedForm) {
  const glm::dvec3 from(0.4, 0.3, 3), to(0.1, 0, 0.2);
  Object object = object_of(plane(1.5, 1, 9, 7), {0.1, -0.05, 0.2});
  object.world_from_object = glm::rotate(object.world_from_object, 0.5, glm::dvec3(0, 1, 0));
  object.world_from_object = glm::scale(object.world_from_object, glm::dvec3(2, 3, 0.5));
  const glm::dvec3 normal(std::sin(0.5), 0, std::cos(0.5)), origin(0.1, -0.05, 0.2);
  const Scene scene = scene_of({object}, device_at(from, to, {160, 120}, 200), {});
  const RayScene rays(scene);
  const SurfaceMap map = trace_surface(rays, scene, scene.cameras[0]);
  const auto points = points_world(map, scene), normals = normals_world(map, rays);
  const PlainCamera camera(from, to, {160, 120}, 200);
  int hits = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      const glm::dvec3 d = camera.ray(x, y);
      const double depth = glm::dot(normal, origin - from) / glm::dot(normal, d);
      const glm::dvec3 expected = from + depth * d;
      if (!map.hit(map.object.index(x, y))) continue;
      ++hits;
      // Double rounding of a few metres, some hundred operations.
      ASSERT_NEAR(glm::distance(points(x, y), expected), 0, 1e-13);
      ASSERT_NEAR(map.depth_m(x, y), depth, 1e-13);
      ASSERT_NEAR(glm::distance(normals(x, y), normal), 0, 1e-14);
      ASSERT_EQ(map.seen_front(x, y), 1);
      ASSERT_EQ(map.albedo(x, y), 0.8f);
    }
  }
  EXPECT_GT(hits, 10000);
}

TEST(TraceSurface, ASpheresSilhouetteLandsWithinHalfAPixel) {
  const glm::dvec3 from(0.5, 0.2, 4), to(0, 0, 0);
  const Scene scene = scene_of({object_of(sphere(1, 200))}, device_at(from, to, {300, 300}, 500), {});
  const SurfaceMap map = trace(scene);
  const PlainCamera camera(from, to, {300, 300}, 500);
  const auto sees = [&](double x,
                        double y) {  // the ray's smallest distance from the sphere's centre is below 1
    const glm::dvec3 d = glm::normalize(camera.ray(x, y));
    return glm::length(glm::cross(from, d)) < 1;
  };
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 300; ++x) {
      const bool hit = map.hit(map.object.index(x, y));
      if (hit == sees(x, y)) continue;
      EXPECT_TRUE(hit == sees(x - 0.5, y) || hit == sees(x + 0.5, y) || hit == sees(x, y - 0.5) ||
                  hit == sees(x, y + 0.5))
          << x << ", " << y;
    }
  }
}

TEST(TraceSurface, TheBackSideIsSeenButBlack) {
  const Scene scene = scene_of({object_of(plane(1, 1))}, device_at({0, 0, -2}, {0, 0, 0}, {40, 40}, 100), {});
  const RayScene rays(scene);
  const SurfaceMap map = trace_surface(rays, scene, scene.cameras[0]);
  EXPECT_TRUE(map.hit(map.object.index(20, 20)));
  EXPECT_EQ(map.seen_front(20, 20), 0);
  EXPECT_EQ(map.albedo(20, 20), 0);
  EXPECT_EQ(normals_world(map, rays)(20, 20), glm::dvec3(0, 0, 1));
}

TEST(TraceSurface, TheFrontSideMovesWithAMirroredObject) {
  Object object = object_of(box({1, 1, 1}));
  object.world_from_object = glm::scale(glm::dmat4(1.0), glm::dvec3(-1, 1, 1));
  const SurfaceMap map = trace(scene_of({object}, device_at({2, 1, 3}, {0, 0, 0}, {40, 40}, 80), {}));
  for (std::size_t p = 0; p < map.object.values.size(); ++p) EXPECT_EQ(map.seen_front.values[p], map.hit(p));
}

TEST(TraceSurface, NearestOfTwoOverlappingMeshesIsSeen) {
  const SurfaceMap map = trace(scene_of({object_of(plane(2, 2)), object_of(plane(1, 1), {0, 0, 0.5})},
                                        device_at({0, 0, 3}, {0, 0, 0}, {101, 101}, 200), {}));
  EXPECT_EQ(map.object(50, 50), 1u);
  EXPECT_DOUBLE_EQ(map.depth_m(50, 50), 2.5);
  EXPECT_EQ(map.object(50, 3), 0u);  // 47 px of 200 at 3 m: y = 0.705; the smaller one ends at 40 px
}

TEST(TraceSurface, AlbedoMapMultiplies) {
  Object object = object_of(plane(1, 1));
  object.albedo_map = std::make_shared<Image<float>>(2, 1, 0.0f);
  const_cast<Image<float>&>(*object.albedo_map).values = {0.25f, 0.75f};
  const SurfaceMap map = trace(scene_of({object}, device_at({0, 0, 2}, {0, 0, 0}, {201, 201}, 400), {}));
  EXPECT_NEAR(map.albedo(50, 100), 0.8 * 0.25, 1e-6);   // s = 0.25: the left texel's centre
  EXPECT_NEAR(map.albedo(150, 100), 0.8 * 0.75, 1e-6);  // s = 0.75
  EXPECT_NEAR(map.albedo(100, 60), 0.8 * 0.5, 1e-6);
}

// Rows do not depend on each other, and a pixel's packet is the same 4×4 tile in any image that holds it.
TEST(TraceSurface, SameBitsForAnyThreadsAndImageSize) {
  Scene scene = scene_of({object_of(relief(2, 2, 0.4, 50, 50)), object_of(sphere(0.3, 20), {0, 0, 0.6})},
                         device_at({0.5, 0.3, 3}, {0, 0, 0}, {121, 90}, 120), {});
  set_thread_count(1);
  const SurfaceMap one = trace(scene);
  for (const int threads : {2, 7}) {
    set_thread_count(threads);
    const SurfaceMap many = trace(scene);
    EXPECT_EQ(many.triangle.values, one.triangle.values);
    EXPECT_EQ(0, std::memcmp(many.point_object.values.data(), one.point_object.values.data(),
                             one.point_object.values.size() * sizeof(glm::dvec3)));
  }
  set_thread_count(0);
  scene.cameras[0].device.intrinsics.size = {66, 51};
  const SurfaceMap part = trace(scene);
  for (int y = 0; y < 51; ++y) {
    for (int x = 0; x < 66; ++x) {
      EXPECT_EQ(part.triangle(x, y), one.triangle(x, y));
      if (one.hit(one.object.index(x, y))) {
        EXPECT_EQ(part.depth_m(x, y), one.depth_m(x, y));
      }
    }
  }
}

}  // namespace
}  // namespace laterna
