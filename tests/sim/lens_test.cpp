#include "sim/lens.h"
#include "sim/spline_knots.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

extern "C" {
#include <mrcal/mrcal.h>
}

#include <cmath>

namespace laterna {
namespace {

const Intrinsics rig_camera{{640, 480}, 625.6, 626.0, 317.9, 241.4};
const Intrinsics rig_projector{{800, 600}, 1377.9, 1372.1, 351.2, 554.8};
const Lens rig_lens{"LENSMODEL_OPENCV4", {-0.0363, 0.0385, -0.0035, -0.0055}};

TEST(Lens, PinholeByHand) {
  const LensProjection pinhole(rig_camera, {});
  EXPECT_TRUE(pinhole.is_pinhole());
  EXPECT_EQ(*pinhole.project({1, 2, 2}), glm::dvec2(625.6 * 0.5 + 317.9, 626.0 * 1 + 241.4));
  EXPECT_FALSE(pinhole.project({1, 2, 0}));
  EXPECT_FALSE(pinhole.project({1, 2, -2}));
  EXPECT_TRUE(std::isinf(pinhole.fold_radius()));
}

TEST(Lens, RadialDistortionByHand) {
  // OPENCV4: x' = x·(1 + k1·r² + k2·r⁴) + 2·p1·x·y + p2·(r² + 2x²), here with r² = 0.05.
  const LensProjection lens(rig_camera, {"LENSMODEL_OPENCV4", {-0.1, 0.02, 0.001, 0.002}});
  const double x = 0.1, y = 0.2, r2 = 0.05, radial = 1 - 0.1 * r2 + 0.02 * r2 * r2;
  const double xd = x * radial + 2 * 0.001 * x * y + 0.002 * (r2 + 2 * x * x);
  const double yd = y * radial + 0.001 * (r2 + 2 * y * y) + 2 * 0.002 * x * y;
  const glm::dvec2 pixel = *lens.project({3 * x, 3 * y, 3});
  EXPECT_NEAR(pixel.x, 625.6 * xd + 317.9, 1e-12);  // 400 px × some eps
  EXPECT_NEAR(pixel.y, 626.0 * yd + 241.4, 1e-12);
}

TEST(Lens, ZeroParametersArePinhole) {
  const LensProjection lens(rig_projector, {"LENSMODEL_OPENCV8", std::vector<double>(8, 0.0)}),
      pinhole(rig_projector, {});
  const glm::dvec3 x(0.3, -0.2, 1.1);
  EXPECT_NEAR(glm::length(*lens.project(x) - *pinhole.project(x)), 0, 1e-12);        // 1000 px × some eps
  EXPECT_NEAR(lens.pixels_per_unit_area(x), pinhole.pixels_per_unit_area(x), 1e-6);  // 2e6 px² × some eps
}

const std::string small_spline = "LENSMODEL_SPLINED_STEREOGRAPHIC_order=3_Nx=6_Ny=5_fov_x_deg=60";

// A knot's parameters move pixels near its u most, x by the even one and y by the odd one.
TEST(Lens, KnotsStandWhereTheirParametersAct) {
  const std::vector<glm::dvec2> knots = spline_knots(small_spline);
  ASSERT_EQ(knots.size(), 30u);
  EXPECT_EQ(int(2 * knots.size()), lens_parameter_count(small_spline));
  const LensProjection plain(rig_camera, {small_spline, std::vector<double>(60, 0.0)});
  for (const int k : {8, 9, 14, 21}) {  // not of the outermost ring, whose u lie beyond the field of view
    for (const int axis : {0, 1}) {
      Lens lens{small_spline, std::vector<double>(60, 0.0)};
      lens.parameters[2 * k + axis] = 0.01;
      const LensProjection moved(rig_camera, lens);
      double most = 0;
      glm::dvec2 where(0.0), step(0.0);
      for (int row = -40; row <= 40; ++row) {
        for (int column = -40; column <= 40; ++column) {
          const glm::dvec2 u = 0.01 * glm::dvec2(column, row);  // u = 2·tan(θ/2): tan θ = |u|/(1 - |u|²/4)
          const glm::dvec3 ray(u / (1 - glm::dot(u, u) / 4), 1);
          const glm::dvec2 d = *moved.project(ray) - *plain.project(ray);
          if (glm::length(d) > most) most = glm::length(d), where = u, step = d;
        }
      }
      EXPECT_LT(glm::length(where - knots[k]), 0.01) << k;  // the grid of u
      EXPECT_GT(step[axis], 0.4 * 0.01 * 625);              // (2/3)² of it at the knot of a cubic B-spline
      EXPECT_NEAR(step[1 - axis], 0, 1e-9);
    }
  }
}

TEST(Lens, SplinedGradientsAreDerivatives) {
  const LensGradient lens(small_spline);
  ASSERT_EQ(lens.parameter_count(), 64);
  std::vector<double> k = {625.6, 626.0, 317.9, 241.4};
  for (int i = 0; i < 60; ++i) k.push_back(0.01 * std::sin(3.0 * i));
  const glm::dvec3 x(0.13, -0.21, 1.1);
  double pixel[2], dx[6];
  std::vector<double> dk(128);
  ASSERT_TRUE(lens.project(k, x, pixel, dx, dk.data()));
  constexpr double step = 1e-6;
  for (int i = 0; i < 64; ++i) {
    std::vector<double> more = k, less = k;
    more[i] += step, less[i] -= step;
    double a[2], b[2];
    ASSERT_TRUE(lens.project(more, x, a, nullptr, nullptr) && lens.project(less, x, b, nullptr, nullptr));
    for (int r = 0; r < 2; ++r)  // linear in each: rounding of 600 px over the step
      EXPECT_NEAR(dk[64 * r + i], (a[r] - b[r]) / (2 * step), 1e-6) << i;
  }
  for (int i = 0; i < 3; ++i) {
    glm::dvec3 more = x, less = x;
    more[i] += step, less[i] -= step;
    double a[2], b[2];
    ASSERT_TRUE(lens.project(k, more, a, nullptr, nullptr) && lens.project(k, less, b, nullptr, nullptr));
    for (int r = 0; r < 2; ++r) EXPECT_NEAR(dx[3 * r + i], (a[r] - b[r]) / (2 * step), 1e-5) << i;
  }
}

TEST(Lens, KnotsOfAnotherModelAreRefused) {
  EXPECT_THAT(testing::input_error([] { spline_knots("LENSMODEL_OPENCV4"); }),
              ::testing::HasSubstr("LENSMODEL_OPENCV4"));
}

TEST(Lens, UnprojectInvertsProjectAndAgreesWithMrcal) {
  for (const Lens& model : {rig_lens, Lens{"LENSMODEL_OPENCV5", {-0.0485, -0.194, 0, 0, 0.738}},
                            Lens{"LENSMODEL_STEREOGRAPHIC", {}}}) {
    const LensProjection lens(rig_projector, model);
    mrcal_lensmodel_t peer_model{};
    ASSERT_TRUE(mrcal_lensmodel_from_name(&peer_model, model.model.c_str()));
    std::vector<double> intrinsics{rig_projector.fx, rig_projector.fy, rig_projector.cx, rig_projector.cy};
    intrinsics.insert(intrinsics.end(), model.parameters.begin(), model.parameters.end());
    std::optional<glm::dvec3> neighbour;
    for (int row = 0; row <= 12; ++row) {
      for (int column = 0; column <= 16; ++column) {
        const double u = 50 * column - 0.5, v = 50 * row - 0.5;
        const auto direction = lens.unproject({u, v}, neighbour);
        ASSERT_TRUE(direction) << model.model << " " << u << " " << v;
        EXPECT_NEAR(glm::length(*lens.project(*direction) - glm::dvec2(u, v)), 0,
                    1e-9);  // the stated tolerance
        const mrcal_point2_t q{.x = u, .y = v};
        mrcal_point3_t peer{};
        ASSERT_TRUE(mrcal_unproject(&peer, &q, 1, &peer_model, intrinsics.data()));
        const glm::dvec2 ours(*direction), theirs(peer.x / peer.z, peer.y / peer.z);
        EXPECT_NEAR(glm::length(ours - theirs) * rig_projector.fx, 0,
                    1e-6);  // mrcal's own solver stops near 2e-8 px
        neighbour = direction;
      }
    }
  }
}

TEST(Lens, TheStartDoesNotChangeTheAnswer) {
  const LensProjection lens(rig_camera, rig_lens);
  const auto cold = lens.unproject({12, 400});
  for (const glm::dvec3& start : {glm::dvec3(0, 0, 1), glm::dvec3(0.6, -0.4, 1), glm::dvec3(5, 5, 1)}) {
    const auto warm = lens.unproject({12, 400}, start);
    ASSERT_TRUE(warm && cold);
    EXPECT_NEAR(glm::length(*warm - *cold), 0, 1e-11);  // 1e-9 px over 600 px, doubled
  }
}

TEST(Lens, FoldRadiusInClosedForm) {
  // r·(1 + k1·r²) turns where 1 + 3·k1·r² = 0.
  const LensProjection lens(rig_camera, {"LENSMODEL_OPENCV4", {-0.3, 0, 0, 0}});
  EXPECT_NEAR(lens.fold_radius(), 1 / std::sqrt(0.9), 1e-9);  // bisected to rounding
  EXPECT_TRUE(lens.project({1.05, 0, 1}));
  EXPECT_FALSE(lens.project({1.06, 0, 1}));
  EXPECT_FALSE(lens.project({5, 0, 1}));  // mrcal itself gives a finite pixel here
}

TEST(Lens, APixelBeyondTheFoldHasNoDirection) {
  const LensProjection lens(rig_camera, {"LENSMODEL_OPENCV4", {-0.3, 0, 0, 0}});
  const double farthest = lens.fold_radius() * (1 - 0.3 * lens.fold_radius() * lens.fold_radius());
  EXPECT_TRUE(lens.unproject({rig_camera.fx * (farthest - 1e-3) + rig_camera.cx, rig_camera.cy}));
  EXPECT_FALSE(lens.unproject({rig_camera.fx * (farthest + 1e-3) + rig_camera.cx, rig_camera.cy}));
  EXPECT_FALSE(lens.unproject({std::nan(""), 0}));
}

TEST(Lens, WarpIsUnprojectWithoutTheLensThenProject) {
  const LensProjection lens(rig_projector, rig_lens);
  const glm::dvec3 x(0.1, 0.05, 1);
  const glm::dvec2 pinhole_pixel(rig_projector.fx * x.x + rig_projector.cx,
                                 rig_projector.fy * x.y + rig_projector.cy);
  EXPECT_NEAR(glm::length(*lens.warp(pinhole_pixel) - *lens.project(x)), 0, 1e-11);  // 1000 px × some eps
}

TEST(LensGradient, EqualsCentralDifferences) {
  for (const Lens& model : {Lens{}, rig_lens}) {
    const LensGradient gradient(model.model);
    std::vector<double> k{1377.9, 1372.1, 351.2, 554.8};
    k.insert(k.end(), model.parameters.begin(), model.parameters.end());
    const int n = gradient.parameter_count();
    ASSERT_EQ(int(k.size()), n);
    const glm::dvec3 x(0.2, -0.15, 1.3);
    double pixel[2], by_x[6], low[2], high[2];
    std::vector<double> by_parameters(2 * n);
    ASSERT_TRUE(gradient.project(k, x, pixel, by_x, by_parameters.data()));
    for (int j = 0; j < 3; ++j) {
      glm::dvec3 a = x, b = x;
      a[j] -= 1e-6, b[j] += 1e-6;
      gradient.project(k, a, low, nullptr, nullptr), gradient.project(k, b, high, nullptr, nullptr);
      for (int i = 0; i < 2; ++i)
        EXPECT_NEAR((high[i] - low[i]) / 2e-6, by_x[3 * i + j], 1e-5);  // 1e-13·1e3/1e-6·…
    }
    for (int j = 0; j < n; ++j) {
      auto a = k, b = k;
      const double h = 1e-6 * std::max(1.0, std::abs(k[j]));
      a[j] -= h, b[j] += h;
      gradient.project(a, x, low, nullptr, nullptr), gradient.project(b, x, high, nullptr, nullptr);
      for (int i = 0; i < 2; ++i) EXPECT_NEAR((high[i] - low[i]) / (2 * h), by_parameters[n * i + j], 1e-5);
    }
  }
}

TEST(LensGradient, RefusesPointsBehind) {
  double pixel[2];
  const std::vector<double> k{1, 1, 0, 0};
  EXPECT_FALSE(LensGradient("LENSMODEL_PINHOLE").project(k, {0, 0, -1}, pixel, nullptr, nullptr));
}

TEST(Lens, RefusesWhatItDoesNotKnow) {
  const auto message = [](const Lens& lens) {
    return testing::input_error([&] { LensProjection(rig_camera, lens); });
  };
  EXPECT_THAT(message({"LENSMODEL_FANCY", {}}), ::testing::HasSubstr("_OPENCV8"));
  EXPECT_THAT(message({"LENSMODEL_LONLAT", {}}), ::testing::HasSubstr("LENSMODEL_LONLAT"));
  EXPECT_THAT(message({"LENSMODEL_OPENCV4", {1, 2}}), ::testing::HasSubstr("found 2 parameters, expected 4"));
  EXPECT_THAT(message({"LENSMODEL_OPENCV4", {1, 2, 3, std::nan("")}}), ::testing::HasSubstr("nan"));
}

}  // namespace
}  // namespace laterna
