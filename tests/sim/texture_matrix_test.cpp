#include "sim/texture_matrix.h"

#include "tests/testing.h"

#include <gmock/gmock.h>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include <cmath>

namespace laterna {
namespace {

using Big = boost::multiprecision::cpp_bin_float_50;

const Intrinsics four_by_two{{4, 2}, 3, 5, 1.5, 0.5};

glm::dvec4 row(const glm::dmat4& m, int i) { return {m[0][i], m[1][i], m[2][i], m[3][i]}; }

void expect_row(const glm::dmat4& m, int i, const glm::dvec4& expected) {
  for (int j = 0; j < 4; ++j) EXPECT_DOUBLE_EQ(row(m, i)[j], expected[j]) << "row " << i << " column " << j;
}

TEST(TextureMatrix, BIsScaleAndBiasByHand) {
  const glm::dmat4 b = texture_from_clip();
  EXPECT_EQ(b * glm::dvec4(-1, -1, -1, 1), glm::dvec4(0, 0, 0, 1));
  EXPECT_EQ(b * glm::dvec4(1, 1, 1, 1), glm::dvec4(1, 1, 1, 1));
  EXPECT_EQ(b * glm::dvec4(0, 1, -1, 1), glm::dvec4(0.5, 1, 0, 1));
}

TEST(TextureMatrix, PByHand) {
  // 4×2 pixels, centred: 2·fx/W = 1.5, 2·fy/H = 5, no shift; near 1, far 3: -(3+1)/(3-1) = -2, -2·3·1/2 = -3.
  const glm::dmat4 p = clip_from_projector(four_by_two, {1.0, 3.0});
  expect_row(p, 0, {1.5, 0, 0, 0});
  expect_row(p, 1, {0, 5, 0, 0});
  expect_row(p, 2, {0, 0, -2, -3});
  expect_row(p, 3, {0, 0, -1, 0});
}

TEST(TextureMatrix, PWithShiftedPrincipalPointByHand) {
  // cx = 3.5 is the right edge: x_clip/w = 1 on the axis; cy = -0.5 is the top edge: y_clip/w = 1 on the
  // axis.
  const glm::dmat4 p = clip_from_projector({{4, 2}, 3, 5, 3.5, -0.5});
  const glm::dvec4 on_axis = p * glm::dvec4(0, 0, -2, 1);
  EXPECT_DOUBLE_EQ(on_axis.x / on_axis.w, 1);
  EXPECT_DOUBLE_EQ(on_axis.y / on_axis.w, 1);
  EXPECT_DOUBLE_EQ(on_axis.w, 2);
}

TEST(TextureMatrix, VFlipsYAndZ) {
  const glm::dmat4 v = projector_from_world({glm::dmat3(1.0), {0.5, 0.25, 2}});
  EXPECT_EQ(v * glm::dvec4(1, 2, 3, 1), glm::dvec4(1.5, -2.25, -5, 1));
}

TEST(TextureMatrix, ProductByHandOnA2x2Picture) {
  // f = 1 px over 2 px: at depth 1 the picture spans 2 m: pixel (0,0) is the quadrant x, y in [-1, 0] m (y
  // down).
  const Intrinsics k{{2, 2}, 1, 1, 0.5, 0.5};
  const glm::dmat4 t = texture_from_object(k, {}, Rigid{});
  const auto pixel = [&](double x, double y, double z) {
    return pixel_from_texture(t * glm::dvec4(x, y, z, 1), k.size);
  };
  EXPECT_EQ(pixel(-0.5, -0.5, 1), glm::dvec2(0, 0));
  EXPECT_EQ(pixel(0.5, -0.5, 1), glm::dvec2(1, 0));
  EXPECT_EQ(pixel(-0.5, 0.5, 1), glm::dvec2(0, 1));
  EXPECT_EQ(pixel(-1, -1, 1), glm::dvec2(-0.5, -0.5));
  EXPECT_EQ(pixel(2, 2, 2), glm::dvec2(1.5, 1.5));
  const glm::dvec4 strq = t * glm::dvec4(-1, -1, 1, 1);  // top left of the picture: s = 0, t = 1
  EXPECT_EQ(glm::dvec2(strq.x, strq.y) / strq.w, glm::dvec2(0, 1));
}

TEST(TextureMatrix, WorldFromObjectIsAppliedFirst) {
  glm::dmat4 world_from_object(1.0);
  world_from_object[0][0] = world_from_object[1][1] = world_from_object[2][2] = 0.001;  // millimetres
  world_from_object[3] = glm::dvec4(0, 0, 2, 1);
  const Intrinsics k{{2, 2}, 1, 1, 0.5, 0.5};
  const glm::dvec4 strq = texture_from_object(k, {}, Rigid{}, world_from_object) * glm::dvec4(1000, 0, 0, 1);
  EXPECT_DOUBLE_EQ(strq.w, 2);
  EXPECT_NEAR(pixel_from_texture(strq, k.size).x, 1.0, 1e-15);  // u = 1·(1 m)/(2 m) + 0.5; 4 eps of rounding
}

TEST(TextureMatrix, PixelAndTextureAreInverse) {
  auto random = testing::generator();
  std::uniform_real_distribution<double> anywhere(-5000, 5000);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec2 pixel(anywhere(random), anywhere(random));
    const glm::dvec2 st = texture_from_pixel(pixel, {1920, 1080});
    const glm::dvec2 back = pixel_from_texture({st.x * 3, st.y * 3, 0, 3}, {1920, 1080});
    EXPECT_NEAR(glm::length(back - pixel), 0, 1e-11);  // 5000 px × a few eps
  }
}

TEST(TextureMatrix, RRowIsAffineInQ) {
  const double n = 0.7, f = 11;
  const glm::dmat4 t = texture_from_object({{640, 480}, 600, 610, 300, 500}, {n, f}, Rigid{});
  for (const double depth : {0.7, 1.0, 5.0, 11.0}) {
    const glm::dvec4 strq = t * glm::dvec4(0.3, -0.2, depth, 1);
    EXPECT_NEAR(strq.z, f / (f - n) * strq.w - f * n / (f - n), 1e-14);  // sizes of about 10: 5 eps
  }
}

struct Rig {
  Intrinsics k;
  Rigid device_from_world;
  glm::dmat4 world_from_object;
  glm::dvec3 object_center;
};

// A random 8K rig whose object and device stand `distance` units from the origin. In `world` the object keeps
// its small coordinates and M moves it; otherwise the object's own coordinates are large.
Rig random_rig(std::mt19937_64& random, double distance) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
  const glm::dvec3 place = distance * glm::normalize(vector());
  Rig rig;
  rig.k = {{7680, 4320},
           9000 + 4000 * unit(random),
           9000 + 4000 * unit(random),
           3840 + 3000 * unit(random),
           2160 + 4000 * unit(random)};
  const glm::dvec3 position = place + 3.0 * glm::normalize(vector());
  rig.device_from_world = device_from_world_looking_at(position, place, vector());
  const Rigid m = rigid_from_rotation_vector(vector(), place);
  rig.world_from_object = matrix_of(m);
  return rig;
}

// The pixel in 50 digits, by the definitions of Intrinsics and Rigid alone (no B, P, V): inputs are exact
// doubles.
std::array<double, 2> reference_error(const Rig& rig, const glm::dvec3& x_object, const glm::dvec2& pixel) {
  std::array<Big, 3> world, device;
  for (int i = 0; i < 3; ++i) {
    world[i] = Big(rig.world_from_object[3][i]);
    for (int j = 0; j < 3; ++j) world[i] += Big(rig.world_from_object[j][i]) * Big(x_object[j]);
  }
  for (int i = 0; i < 3; ++i) {
    device[i] = Big(rig.device_from_world.translation[i]);
    for (int j = 0; j < 3; ++j) device[i] += Big(rig.device_from_world.rotation[j][i]) * world[j];
  }
  const Big u = Big(rig.k.fx) * device[0] / device[2] + Big(rig.k.cx);
  const Big v = Big(rig.k.fy) * device[1] / device[2] + Big(rig.k.cy);
  return {abs(u - Big(pixel.x)).convert_to<double>(), abs(v - Big(pixel.y)).convert_to<double>()};
}

double worst_error_over_frustum(double distance) {
  auto random = testing::generator();
  std::uniform_real_distribution<double> unit(-1, 1);
  double worst = 0;
  for (int i = 0; i < 300; ++i) {
    const Rig rig = random_rig(random, distance);
    const glm::dmat4 t = texture_from_object(rig.k, {}, rig.device_from_world, rig.world_from_object);
    for (int j = 0; j < 30; ++j) {
      const glm::dvec3 x(unit(random), unit(random), unit(random));
      const glm::dvec2 pixel = pixel_from_texture(t * glm::dvec4(x, 1), rig.k.size);
      if (pixel.x < -0.5 || pixel.x > 7679.5 || pixel.y < -0.5 || pixel.y > 4319.5) continue;
      const auto error = reference_error(rig, x, pixel);
      worst = std::max({worst, error[0], error[1]});
    }
  }
  EXPECT_GT(worst, 0);  // some points fell inside
  return worst;
}

// The bound: 1e-9 px at 8K; 8000 px × eps × about 10 operations is 2e-11.
TEST(TextureMatrix, AgreesWith50DigitsOverTheFrustum) { EXPECT_LE(worst_error_over_frustum(0), 1e-9); }

// The bound: 1e-5 px; translations of 1e6 cancel with 1e6·eps = 2e-10 m, times 13000 px over 3 m:
// 1e-6 px.
TEST(TextureMatrix, AgreesWith50DigitsAMillionUnitsAway) { EXPECT_LE(worst_error_over_frustum(1e6), 1e-5); }

TEST(TextureMatrix, DecomposesToItsParts) {
  auto random = testing::generator();
  for (int i = 0; i < 200; ++i) {
    const Rig rig = random_rig(random, 1);
    const double factor = i % 2 ? -3.7 : 0.02;  // T is homogeneous; its sign is free too
    const auto parts = decompose(factor * texture_from_object(rig.k, {}, rig.device_from_world), rig.k.size);
    // Focal lengths of 1e4 px and products of some 20 operations: 1e4 × 1e-14.
    EXPECT_NEAR(parts.intrinsics.fx, rig.k.fx, 1e-8);
    EXPECT_NEAR(parts.intrinsics.fy, rig.k.fy, 1e-8);
    EXPECT_NEAR(parts.intrinsics.cx, rig.k.cx, 1e-8);
    EXPECT_NEAR(parts.intrinsics.cy, rig.k.cy, 1e-8);
    EXPECT_NEAR(parts.skew_px, 0, 1e-8);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(glm::length(parts.device_from_world.rotation[c] - rig.device_from_world.rotation[c]), 0,
                  1e-12);
    }
    EXPECT_NEAR(glm::length(parts.device_from_world.translation - rig.device_from_world.translation), 0,
                1e-11);
  }
}

TEST(TextureMatrix, DecomposeRefusesASingularMatrix) {
  EXPECT_THAT(testing::input_error([] {
                decompose(glm::dmat4(0.0), {4, 4});
              }),
              ::testing::HasSubstr("singular"));
  glm::dmat4 parallel(1.0);  // an orthographic map: its q row has no direction
  EXPECT_THAT(testing::input_error([&] { decompose(parallel, {4, 4}); }), ::testing::HasSubstr("singular"));
}

TEST(LightPlanes, RefusesWhatIsNoInterval) {
  validate(LightPlanes{0.1, 20.0}, "left");
  EXPECT_THAT(testing::input_error([] {
                validate(LightPlanes{2.0, 2.0}, "left");
              }),
              ::testing::HasSubstr("near < far"));
  EXPECT_THAT(testing::input_error([] {
                validate(LightPlanes{-1.0, {}}, "left");
              }),
              ::testing::HasSubstr("positive"));
  EXPECT_THAT(testing::input_error([] {
                validate(LightPlanes{{}, INFINITY}, "left");
              }),
              ::testing::HasSubstr("inf"));
}

}  // namespace
}  // namespace laterna
