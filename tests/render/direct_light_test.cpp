#include "render/direct_light.h"

#include "sim/parallel.h"
#include "tests/render/rig.h"
#include "tests/testing.h"

#include <cstring>

namespace laterna {
namespace {

using testing::device_at;
using testing::object_of;
using testing::scene_of;
using testing::Traced;

TEST(TraceLight, AFacingPlaneIsEvenlyLitAndFallsWithTheSquareOfItsDistance) {
  const Device camera = device_at({0, 0, 2}, {0, 0, 0}, {60, 40}, 80);
  Scene scene =
      scene_of({object_of(plane(4, 4))}, camera, device_at({0.2, -0.1, 2}, {0.2, -0.1, 0}, {100, 80}, 60));
  for (const double z : {2.0, 4.0}) {
    scene.projectors[0].device.device_from_world =
        device_from_world_looking_at({0.2, -0.1, z}, {0.2, -0.1, 0}, {0, 1, 0});
    const Traced traced(scene);
    EXPECT_EQ(traced.count(Unlit::lit), 2400);
    const double expected = 1000.0 / 8000 * 60 * 60 / (z * z);
    for (const double e : traced.light.white_lx.values)
      EXPECT_NEAR(e, expected, 1e-12 * expected);  // rounding
  }
}

// Where the lens packs more pixels into a solid angle, it sends more light there.
TEST(TraceLight, ALensTradesDensityForLight) {
  Scene scene = scene_of({object_of(plane(4, 4))}, device_at({0, 0, 2}, {0, 0, 0}, {60, 40}, 80),
                         device_at({0.3, 0.1, 2}, {0.1, 0, 0}, {100, 80}, 60));
  const Traced pinhole(scene);
  Device& device = scene.projectors[0].device;
  device.lens = {"LENSMODEL_OPENCV4", {0.0, 0.0, 0.0, 0.0}};
  const Traced same(scene);
  device.lens.parameters = {-0.08, 0, 0, 0};
  const Traced bent(scene);
  for (std::size_t p = 0; p < pinhole.light.white_lx.values.size(); ++p) {
    EXPECT_NEAR(same.light.white_lx.values[p], pinhole.light.white_lx.values[p], 1e-12 * 1000);
    if (!bent.light.lit(p) || !pinhole.light.lit(p)) continue;
    // u = 60·x(1 + k r²): the Jacobian's determinant is f²(1 + k r²)(1 + 3 k r²).
    const double x = (pinhole.light.u_px.values[p] - 49.5) / 60,
                 y = (pinhole.light.v_px.values[p] - 39.5) / 60;
    const double kr2 = -0.08 * (x * x + y * y);
    EXPECT_NEAR(bent.light.u_px.values[p], 49.5 + 60 * x * (1 + kr2), 1e-9);
    EXPECT_NEAR(bent.light.white_lx.values[p], pinhole.light.white_lx.values[p] * (1 + kr2) * (1 + 3 * kr2),
                1e-9);
  }
  EXPECT_GT(bent.count(Unlit::lit), 1000);
}

TEST(TraceLight, AShadowsEdgeOfABoxAboveAPlane) {
  // Light from straight above at 2 m; the box's top is at 0.5 m, half a side is 0.2 m: the shadow's half side
  // on the plane is 0.2·2/1.5.
  const double half = 0.2 * 2 / 1.5;
  const glm::dvec3 from(1.1, 0.7, 1.8), to(0, 0, 0.1);
  const Traced traced(scene_of({object_of(plane(3, 3)), object_of(box({0.4, 0.4, 0.2}), {0, 0, 0.4})},
                               device_at(from, to, {400, 300}, 500),
                               device_at({0, 0, 2}, {0, 0, 0}, {100, 100}, 60)));
  const glm::dvec3 forward = glm::normalize(to - from),
                   right = glm::normalize(glm::cross(forward, {0, 1, 0})), down = glm::cross(forward, right);
  const auto dark = [&](double x, double y) {
    const glm::dvec3 d = forward + (x - 199.5) / 500 * right + (y - 149.5) / 500 * down;
    const glm::dvec3 on_plane = from - from.z / d.z * d;
    return std::max(std::abs(on_plane.x), std::abs(on_plane.y)) < half;
  };
  int shadows = 0;
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 400; ++x) {
      const std::size_t p = traced.surface.object.index(x, y);
      if (traced.surface.object.values[p] != 0) continue;
      const auto why = Unlit(traced.light.why.values[p]);
      ASSERT_TRUE(why == Unlit::lit || why == Unlit::shadow);
      const bool shadow = why == Unlit::shadow;
      shadows += shadow;
      if (shadow == dark(x, y)) continue;
      EXPECT_TRUE(shadow == dark(x - 0.5, y) || shadow == dark(x + 0.5, y) || shadow == dark(x, y - 0.5) ||
                  shadow == dark(x, y + 0.5))
          << x << ", " << y;
    }
  }
  EXPECT_GT(shadows, 1000);
}

TEST(TraceLight, EachReasonToBeDark) {
  const Device camera = device_at({0, 0, 2}, {0, 0, 0}, {40, 40}, 60);
  const auto whole = [&](const Device& projector) {
    return Traced(scene_of({object_of(plane(1, 1))}, camera, projector));
  };
  const int seen = whole(camera).surface.hit(0) ? 1600 : whole(camera).count(Unlit::lit);
  ASSERT_GT(seen, 800);
  // Turned away: without the test of q the picture would stand mirrored on the plane.
  EXPECT_EQ(whole(device_at({0, 0, 2}, {0, 0, 4}, {40, 40}, 20)).count(Unlit::behind), seen);
  EXPECT_EQ(whole(device_at({0, 0, -2}, {0, 0, 0}, {40, 40}, 20)).count(Unlit::back_face), seen);
  EXPECT_EQ(whole(device_at({0, 0, 2}, {3, 0, 0}, {4, 4}, 20)).count(Unlit::outside), seen);
  Device planes = device_at({0, 0, 2}, {0, 0, 0}, {40, 40}, 20);
  planes.planes = {std::nullopt, 1.9};
  EXPECT_EQ(whole(planes).count(Unlit::beyond_far), seen);
  planes.planes = {2.1, std::nullopt};
  EXPECT_EQ(whole(planes).count(Unlit::before_near), seen);
  EXPECT_EQ(whole(planes).count(Unlit::no_surface), 1600 - seen);
  // A camera behind the surface sees the unlit side.
  const Traced back(
      scene_of({object_of(plane(1, 1))}, device_at({0, 0, -2}, {0, 0, 0}, {40, 40}, 60), camera));
  EXPECT_EQ(back.count(Unlit::back_face), seen);
  for (const double e : back.light.white_lx.values) EXPECT_EQ(e, 0);
}

TEST(TraceLight, TwoMeshesInOnePlaceAreLitOnce) {
  const Mesh mesh = relief(1, 1, 0.1, 20, 20);
  const Device camera = device_at({0.2, 0, 2}, {0, 0, 0}, {100, 100}, 300),
               projector = device_at({-0.2, 0, 2}, {0, 0, 0}, {100, 100}, 150);
  const Traced once(scene_of({object_of(mesh)}, camera, projector));
  const Traced twice(scene_of({object_of(mesh), object_of(mesh)}, camera, projector));
  EXPECT_EQ(once.light.why.values, twice.light.why.values);
  EXPECT_EQ(once.light.white_lx.values, twice.light.white_lx.values);
}

// In double, coordinates of 1e6 m have steps of 1.2e-10 m; at f/z = 200 px/m that is 2.4e-8 px each,
// for the hit point, T's translation and the camera. 1e-5 px is the project's promise.
TEST(TraceLight, ASceneAMillionMetresAwayGivesTheSamePixels) {
  const glm::dvec3 far(1e6, -1e6, 0.5e6);
  const auto at = [&](const glm::dvec3& place, bool in_vertices) {
    Object object = object_of(relief(1, 1, 0.3, 30, 30));
    if (in_vertices) {
      for (auto& p : object.mesh.positions) p += place;
    } else {
      object.world_from_object[3] = glm::dvec4(place, 1);
    }
    return Traced(scene_of({object}, device_at(glm::dvec3(0.3, 0.2, 2) + place, place, {160, 120}, 250),
                           device_at(glm::dvec3(-0.4, 0.1, 2) + place, place, {320, 240}, 400)));
  };
  const Traced here = at(glm::dvec3(0.0), false);
  for (const bool in_vertices : {false, true}) {
    const Traced there = at(far, in_vertices);
    int compared = 0, changed = 0;
    for (std::size_t p = 0; p < here.light.why.values.size(); ++p) {
      changed += here.light.why.values[p] != there.light.why.values[p] ||
                 here.surface.triangle.values[p] != there.surface.triangle.values[p];
      if (!here.light.lit(p) || !there.light.lit(p)) continue;
      ++compared;
      ASSERT_NEAR(here.light.u_px.values[p], there.light.u_px.values[p], 1e-5);
      ASSERT_NEAR(here.light.v_px.values[p], there.light.v_px.values[p], 1e-5);
    }
    EXPECT_GT(compared, 5000);
    EXPECT_LE(changed, 10);  // rays that pass an edge or a shadow's edge within rounding
  }
}

TEST(TraceLight, SameBitsForAnyThreads) {
  const Scene scene =
      scene_of({object_of(relief(2, 2, 0.4, 50, 50)), object_of(sphere(0.3, 20), {0, 0, 0.6})},
               device_at({0.5, 0.3, 3}, {0, 0, 0}, {121, 90}, 120),
               device_at({-0.5, 0.3, 3}, {0, 0, 0}, {200, 150}, 180));
  set_thread_count(1);
  const Traced one(scene);
  for (const int threads : {2, 7}) {
    set_thread_count(threads);
    const Traced many(scene);
    EXPECT_EQ(many.light.why.values, one.light.why.values);
    EXPECT_EQ(many.light.white_lx.values, one.light.white_lx.values);
    EXPECT_EQ(0, std::memcmp(many.light.u_px.values.data(), one.light.u_px.values.data(),
                             121 * 90 * sizeof(double)));
  }
  set_thread_count(0);
}

TEST(TraceLight, SwitchesTakeOneReasonAwayEach) {
  Scene scene = scene_of({object_of(plane(1, 1)), object_of(box({0.2, 0.2, 0.2}), {0, 0, 0.5})},
                         device_at({0.6, 0, 2}, {0, 0, 0}, {60, 60}, 90),
                         device_at({0, 0, 2}, {0, 0, 0}, {40, 40}, 100));
  scene.projectors[0].device.planes = {std::nullopt, 1.45};  // ends before the box's top, at 1.4 m, does
  const Traced all(scene);
  ASSERT_GT(all.count(Unlit::beyond_far), 100);
  scene.effects.light_planes = false;
  const Traced no_planes(scene);
  EXPECT_EQ(no_planes.count(Unlit::beyond_far), 0);
  ASSERT_GT(no_planes.count(Unlit::shadow), 20);
  ASSERT_GT(no_planes.count(Unlit::outside), 20);
  scene.effects.shadow = false;
  const Traced no_shadow(scene);
  EXPECT_EQ(no_shadow.count(Unlit::shadow), 0);
  EXPECT_EQ(no_shadow.count(Unlit::lit), no_planes.count(Unlit::lit) + no_planes.count(Unlit::shadow));
  scene.effects.border = false;
  const Traced no_border(scene);
  EXPECT_EQ(no_border.count(Unlit::outside), 0);
  for (std::size_t p = 0; p < no_border.light.white_lx.values.size(); ++p) {
    if (!no_planes.light.lit(p)) continue;
    EXPECT_EQ(no_border.light.white_lx.values[p], no_planes.light.white_lx.values[p]);
    EXPECT_EQ(no_border.light.u_px.values[p], no_planes.light.u_px.values[p]);
  }
}

TEST(TraceLight, WithoutBackFaceBothSidesAreLitAndSeen) {
  const Device above = device_at({0.3, 0, 2}, {0, 0, 0}, {40, 40}, 60),
               below = device_at({0.3, 0, -2}, {0, 0, 0}, {40, 40}, 60),
               projector = device_at({0.1, 0, -2}, {0, 0, 0}, {40, 40}, 60);
  for (const Device& camera : {above, below}) {
    Scene scene = scene_of({object_of(plane(1, 1))}, camera, projector);
    ASSERT_EQ(Traced(scene).count(Unlit::lit), 0);
    scene.effects.back_face = false;
    const Traced both(scene);
    EXPECT_GT(both.count(Unlit::lit), 500);  // shadow rays start on the projector's side
    EXPECT_EQ(both.count(Unlit::back_face) + both.count(Unlit::shadow), 0);
    for (std::size_t p = 0; p < both.light.why.values.size(); ++p) {
      if (!both.light.lit(p)) continue;
      // Tilted by atan(0.05) off the plane's axis: E = Φ·f²·h/z³, z along the projector's axis.
      const glm::dvec3 x(both.surface.point_object.values[p]), axis = glm::normalize(glm::dvec3(-0.1, 0, 2));
      const double z = glm::dot(x - glm::dvec3(0.1, 0, -2), axis);
      EXPECT_NEAR(both.light.white_lx.values[p], 1000.0 / 1600 * 3600 * 2 / (z * z * z), 1e-9);
      EXPECT_FLOAT_EQ(both.surface.albedo.values[p], 0.8f);
    }
  }
}

TEST(TraceLight, WithoutIrradianceEveryLitPointGetsWhatAFacingPlaneAtOneMetreGets) {
  Scene scene =
      scene_of({object_of(relief(2, 2, 0.4, 20, 20))}, device_at({0.2, 0, 2}, {0, 0, 0}, {60, 40}, 80),
               device_at({-0.2, 0, 2}, {0, 0, 0}, {100, 80}, 60));
  const Traced on(scene);
  scene.effects.irradiance = false;
  const Traced off(scene);
  EXPECT_EQ(on.light.why.values, off.light.why.values);
  for (std::size_t p = 0; p < off.light.why.values.size(); ++p)
    EXPECT_EQ(off.light.white_lx.values[p], off.light.lit(p) ? 1000.0 / 8000 * 3600 : 0);
}

}  // namespace
}  // namespace laterna
