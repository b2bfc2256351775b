#include "calib/geometry_check.h"

#include "tests/calib/synthetic.h"
#include "tests/testing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;

Correspondences usual(int n) {
  auto random = testing::generator();
  return testing::scattered(testing::usual_projector(), n, 2, 4, 0.1, random);
}

TEST(Correspondences, SayWhatIsWrong) {
  EXPECT_NO_THROW(validate(usual(10)));
  auto c = usual(10);
  c.sigma_px.pop_back();
  EXPECT_THAT(testing::input_error([&] { validate(c); }), HasSubstr("9 sigmas"));
  c = usual(10);
  c.cluster = {1, 2};
  EXPECT_THAT(testing::input_error([&] { validate(c); }), HasSubstr("2 cluster ids"));
  c = usual(10);
  c.world_points[3].y = std::nan("");
  EXPECT_THAT(testing::input_error([&] { validate(c); }), HasSubstr("correspondence 3"));
  c = usual(10);
  c.projector_pixels[4].x = INFINITY;
  EXPECT_THAT(testing::input_error([&] { validate(c); }), HasSubstr("correspondence 4"));
  for (const double sigma : {0.0, -1.0, double(INFINITY), std::nan("")}) {
    c = usual(10);
    c.sigma_px[5] = sigma;
    EXPECT_THAT(testing::input_error([&] { validate(c); }), HasSubstr("correspondence 5: sigma"));
  }
}

TEST(Correspondences, EvenlySpread) {
  EXPECT_EQ(evenly_spread(3, 5), (std::vector<std::size_t>{0, 1, 2}));
  const auto chosen = evenly_spread(1000000, 1000);
  ASSERT_EQ(chosen.size(), 1000u);
  EXPECT_LT(chosen.back(), 1000000u);
  std::vector<int> columns(10);
  for (std::size_t k = 1; k < chosen.size(); ++k) EXPECT_LT(chosen[k - 1], chosen[k]);
  for (const std::size_t i : chosen) ++columns[i % 1000 / 100];  // of a raster 1000 wide
  for (const int count : columns) EXPECT_NEAR(count, 100, 30);   // a plain stride would fill one only
}

TEST(GeometryCheck, SoundPoints) {
  const auto report = check_geometry(usual(6), 10);
  EXPECT_EQ(report.verdict, Geometry::sound);
  EXPECT_EQ(report.reason, "");
}

TEST(GeometryCheck, SpreadByHand) {
  Correspondences c;
  for (const double x : {-3.0, 3.0})
    for (const double y : {-2.0, 2.0})
      for (const double z : {-1.0, 1.0}) {
        c.world_points.push_back(glm::dvec3(x, y, z) + glm::dvec3(10, 20, 30));
        c.projector_pixels.push_back({x, y + z});
        c.sigma_px.push_back(1);
      }
  const auto report = check_geometry(c, 10);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(report.spread_m[i], 3 - i, 1e-14);  // rounding
  EXPECT_NEAR(std::abs(report.thin_axis_world.z), 1, 1e-14);
  const Rigid device_from_world{glm::dmat3(1.0), {-10, -20, -20}};  // the centroid stands 10 m ahead
  EXPECT_NEAR(relief_over_throw(c, report, device_from_world), 0.2, 1e-14);
}

TEST(GeometryCheck, TooFew) {
  for (int n = 0; n < 6; ++n) {
    const auto report = check_geometry(usual(n), 10);
    EXPECT_EQ(report.verdict, Geometry::too_few);
    EXPECT_THAT(report.reason, HasSubstr(std::to_string(n) + " correspondences"));
  }
  EXPECT_EQ(check_geometry(usual(6), 14).verdict, Geometry::too_few);  // 12 equations for 14 parameters
}

TEST(GeometryCheck, IdenticalCollinearCoplanar) {
  for (const double away : {0.0, 1e6}) {  // rounding of far coordinates is no relief
    auto same = usual(50), line = same, plane = same;
    for (int i = 0; i < 50; ++i) {
      const glm::dvec3 origin(away, away, -away);
      same.world_points[i] = origin;
      line.world_points[i] = origin + glm::dvec3(0.3, -0.4, 0.7) * (0.1 * i);
      plane.world_points[i] =
          origin + glm::dvec3(0.3, 0.4, 0.7) * (0.1 * i) + glm::dvec3(1.1, -0.3, 0.2) * (0.01 * i * i);
    }
    EXPECT_EQ(check_geometry(same, 10).verdict, Geometry::identical) << away;
    EXPECT_EQ(check_geometry(line, 10).verdict, Geometry::collinear) << away;
    EXPECT_EQ(check_geometry(plane, 10).verdict, Geometry::coplanar) << away;
    EXPECT_THAT(check_geometry(plane, 10).reason, HasSubstr("one plane"));
    plane.world_points[7].x += 1e-6;  // thin, but not a plane: passes here
    EXPECT_EQ(check_geometry(plane, 10).verdict, Geometry::sound) << away;
  }
}

TEST(GeometryCheck, PixelsOnALine) {
  auto c = usual(50), d = c;
  for (int i = 0; i < 50; ++i) c.projector_pixels[i] = {3.0 * i, 1 + 2.0 * i}, d.projector_pixels[i] = {5, 5};
  EXPECT_EQ(check_geometry(c, 10).verdict, Geometry::pixels_collinear);
  EXPECT_EQ(check_geometry(d, 10).verdict, Geometry::pixels_collinear);
}

}  // namespace
}  // namespace laterna
