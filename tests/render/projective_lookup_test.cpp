#include "render/projective_lookup.h"

#include "tests/render/rig.h"
#include "tests/testing.h"

namespace laterna {
namespace {

using testing::device_at;

// At the origin, looking along +z, 2×2 pixels: u = x/z + 0.5, v = y/z + 0.5.
Projector two_by_two() {
  Projector projector;
  projector.device.name = "projector";
  projector.device.intrinsics = {{2, 2}, 1, 1, 0.5, 0.5};
  return projector;
}

TEST(ProjectiveLookup, TwoByTwoByHand) {
  const ProjectiveLookup lookup(two_by_two());
  const struct {
    glm::dvec3 x;
    double u, v;
    int column, row;
  } cases[] = {{{0, 0, 2}, 0.5, 0.5, 1, 1},  // the picture's middle belongs to the texel right and below
               {{-1, -1, 2}, 0, 0, 0, 0},    // the centre of the upper left pixel: left is -x, up is -y
               {{1, -1, 2}, 1, 0, 1, 0},
               {{-1, 1, 2}, 0, 1, 0, 1},
               {{-2, -2, 2}, -0.5, -0.5, 0, 0}};  // the corner itself is lit
  for (const auto& c : cases) {
    const ProjectedPoint p = lookup.project(c.x);
    EXPECT_EQ(p.why, Unlit::lit);
    EXPECT_DOUBLE_EQ(p.u_px, c.u);
    EXPECT_DOUBLE_EQ(p.v_px, c.v);
    EXPECT_EQ(p.depth_m, 2);
    EXPECT_EQ(nearest_texel(p.u_px, 2), c.column);
    EXPECT_EQ(nearest_texel(p.v_px, 2), c.row);
  }
}

TEST(ProjectiveLookup, UpsideDownAndPortraitByHand) {
  // Upside down: 180° about z. What was upper left is lower right.
  Projector projector = two_by_two();
  projector.device.device_from_world.rotation = glm::dmat3(-1, 0, 0, 0, -1, 0, 0, 0, 1);
  ProjectedPoint p = ProjectiveLookup(projector).project({-1, -1, 2});
  EXPECT_DOUBLE_EQ(p.u_px, 1);
  EXPECT_DOUBLE_EQ(p.v_px, 1);
  // Portrait: the device's x is the world's y, its y the world's -x.
  projector.device.device_from_world.rotation = glm::dmat3(0, -1, 0, 1, 0, 0, 0, 0, 1);
  p = ProjectiveLookup(projector).project({-1, -1, 2});
  EXPECT_DOUBLE_EQ(p.u_px, 0);
  EXPECT_DOUBLE_EQ(p.v_px, 1);
}

TEST(ProjectiveLookup, LightEndsAtTheImagesEdge) {
  Projector projector = two_by_two();
  projector.device.intrinsics = {{4, 3}, 1, 1, 1.5, 1};
  const auto why = [&](double u, double v) {
    return ProjectiveLookup(projector).project({u - 1.5, v - 1, 1}).why;
  };
  constexpr double e = 1e-9;
  EXPECT_EQ(why(3.5 - e, 1), Unlit::lit);
  EXPECT_EQ(why(3.5 + e, 1), Unlit::outside);
  EXPECT_EQ(why(-0.5 + e, 1), Unlit::lit);
  EXPECT_EQ(why(-0.5 - e, 1), Unlit::outside);
  EXPECT_EQ(why(1, 2.5 - e), Unlit::lit);
  EXPECT_EQ(why(1, 2.5 + e), Unlit::outside);
  EXPECT_EQ(why(1, 2.5), Unlit::outside);
  EXPECT_EQ(why(1, -0.5 + e), Unlit::lit);
  EXPECT_EQ(why(1, -0.5 - e), Unlit::outside);
  projector.border = Border::clamp;
  EXPECT_EQ(why(9, -7), Unlit::lit);
}

TEST(ProjectiveLookup, BehindAndLightPlanes) {
  Projector projector = two_by_two();
  projector.device.planes = {0.5, 3.0};
  const ProjectiveLookup lookup(projector);
  EXPECT_EQ(lookup.project({0, 0, -2}).why, Unlit::behind);  // would divide to the middle of the picture
  EXPECT_EQ(lookup.project({0, 0, 0}).why, Unlit::behind);
  EXPECT_TRUE(std::isnan(lookup.project({0, 0, -2}).u_px));
  EXPECT_EQ(lookup.project({0, 0, 0.5 - 1e-9}).why, Unlit::before_near);
  EXPECT_EQ(lookup.project({0, 0, 0.5}).why, Unlit::lit);
  EXPECT_EQ(lookup.project({0, 0, 3}).why, Unlit::lit);
  EXPECT_EQ(lookup.project({0, 0, 3 + 1e-9}).why, Unlit::beyond_far);
  EXPECT_EQ(ProjectiveLookup(two_by_two()).project({0, 0, 1e-6}).why, Unlit::lit);  // no planes
}

TEST(ProjectiveLookup, PerVertexIsPerSample) {
  auto random = testing::generator();
  std::uniform_real_distribution<double> unit(-1, 1);
  Projector projector;
  projector.device = device_at({1, 2, 5}, {0, 0, 0}, {1920, 1080}, 2500);
  const glm::dmat4 world_from_object = glm::translate(glm::dmat4(1.0), glm::dvec3(0.1, 0.2, 0.3)) *
                                       glm::scale(glm::dmat4(1.0), glm::dvec3(0.7));
  const ProjectiveLookup lookup(projector, world_from_object);
  const glm::dmat4 t = texture_from_object(projector.device.intrinsics, {},
                                           projector.device.device_from_world, world_from_object);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 a(unit(random), unit(random), unit(random)), b(unit(random), unit(random), unit(random));
    const double share = 0.5 + 0.5 * unit(random);
    const glm::dvec3 x = (1 - share) * a + share * b;
    const ProjectedPoint sample = lookup.project(x);
    const ProjectedPoint vertex =
        lookup.divide((1 - share) * lookup.homogeneous_pixel(a) + share * lookup.homogeneous_pixel(b));
    const glm::dvec2 whole = pixel_from_texture(t * glm::dvec4(x, 1.0), {1920, 1080});
    // Rounding only: a few hundred steps of 2000 px in double.
    EXPECT_NEAR(vertex.u_px, sample.u_px, 1e-9);
    EXPECT_NEAR(vertex.v_px, sample.v_px, 1e-9);
    EXPECT_NEAR(whole.x, sample.u_px, 1e-9);
    EXPECT_NEAR(whole.y, sample.v_px, 1e-9);
  }
}

TEST(ProjectiveLookup, LensWarpsAfterTheDivideAndEndsAtItsFold) {
  Projector projector;
  projector.device = device_at({0.2, 0.1, 2}, {0, 0, 0}, {800, 600}, 700);
  projector.device.lens = {"LENSMODEL_OPENCV4", {-0.2, 0.0, 0.001, -0.002}};
  projector.border = Border::clamp;
  const ProjectiveLookup lookup(projector);
  const WorldProjection reference(projector.device);
  for (const glm::dvec3 x :
       {glm::dvec3(0.1, 0.2, 0), glm::dvec3(-0.4, 0.3, 0.1), glm::dvec3(0.5, -0.4, -0.2)}) {
    const ProjectedPoint p = lookup.project(x);
    const glm::dvec3 expected = reference.project(x);
    EXPECT_EQ(p.why, Unlit::lit);
    EXPECT_NEAR(p.u_px, expected.x, 1e-9);
    EXPECT_NEAR(p.v_px, expected.y, 1e-9);
  }
  EXPECT_EQ(lookup.project({20, 0, 0}).why, Unlit::lens);  // r = 10, the fold is near 1/sqrt(0.6) = 1.3
}

TEST(NearestTexel, BoxesAndEdges) {
  EXPECT_EQ(nearest_texel(-0.5, 4), 0);
  EXPECT_EQ(nearest_texel(0.5 - 1e-9, 4), 0);
  EXPECT_EQ(nearest_texel(0.5, 4), 1);
  EXPECT_EQ(nearest_texel(3.5 - 1e-9, 4), 3);
  EXPECT_EQ(nearest_texel(3.5 + 1e-9, 4), 3);  // only with Border::clamp
  EXPECT_EQ(nearest_texel(-1e9, 4), 0);
  EXPECT_EQ(nearest_texel(1e12, 4), 3);
}

TEST(LinearTaps, BetweenCentresAndClampedInsideTheEdge) {
  const auto taps = [](double u) {
    const LinearTaps t = linear_taps(u, 4);
    return std::tuple(t.first, t.second, t.share);
  };
  EXPECT_EQ(taps(0), std::tuple(0, 1, 0.0));
  EXPECT_EQ(taps(1.25), std::tuple(1, 2, 0.25));
  EXPECT_EQ(taps(-0.5), std::tuple(0, 1, 0.0));
  EXPECT_EQ(taps(3), std::tuple(3, 3, 0.0));
  EXPECT_EQ(taps(3.5 - 1e-9), std::tuple(3, 3, 0.0));
  EXPECT_EQ(linear_taps(0.3, 1).second, 0);
}

}  // namespace
}  // namespace laterna
