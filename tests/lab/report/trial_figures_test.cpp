#include "apps/lab/report/trial_figures.h"

#include "tests/calib/synthetic.h"

#include <gtest/gtest.h>

namespace laterna {
namespace {

using nlohmann::json;

// 40×30 camera pixels that see points 2 to 3 m before the projector, decoded `off` beside where they are.
struct Seen {
  Device projector = testing::usual_projector();
  DecodedMap decoded{40, 30};
  PixelArray<glm::dvec3> points_world{40, 30};
};

Seen seen(const glm::dvec2& off, double sigma_px) {
  Seen s;
  const WorldProjection projection(s.projector);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      const glm::dvec2 pixel(30.0 * x + 20, 25.0 * y + 20);
      s.points_world.values[s.points_world.index(x, y)] = *projection.unproject(pixel, 2 + 0.025 * x);
      s.decoded.u_px(x, y) = pixel.x + off.x, s.decoded.v_px(x, y) = pixel.y + off.y;
      s.decoded.sigma_px(x, y) = float(sigma_px), s.decoded.valid(x, y) = 1;
    }
  return s;
}

TEST(ResidualFigure, IsDecodedMinusProjected) {
  Seen s = seen({0.3, -0.4}, 0.25);
  s.decoded.valid(0, 0) = 0;
  const json r = residual_figure(s.decoded, s.points_world, s.projector, "c", "p");
  EXPECT_EQ(r["points"], 1199);
  EXPECT_NEAR(r["rms_px"].get<double>(), 0.5, 1e-9);  // 3, 4, 5; what is left is rounding
  EXPECT_NEAR(r["sigma_px"].get<double>(), 0.25, 1e-9);
  EXPECT_NEAR(r["sample"][0][2].get<double>(), 0.3, 1e-6);  // six digits are kept
  EXPECT_NEAR(r["sample"][0][3].get<double>(), -0.4, 1e-6);
}

TEST(ResidualFigure, HistogramCountsBothAndPredictsNormalDeviates) {
  const Seen s = seen({0.3, -0.4}, 0.25);
  const json h = residual_figure(s.decoded, s.points_world, s.projector, "c", "p")["histogram"];
  int count = 0;
  double predicted = 0;
  for (const int n : h["count"].get<std::vector<int>>()) count += n;
  for (const double n : h["predicted"].get<std::vector<double>>()) predicted += n;
  EXPECT_EQ(count, 2400);
  // It spans 4·0.5/√2 px: 5.66 sigma, beyond which one deviate in 10⁷ lies.
  EXPECT_NEAR(predicted, 2400, 1e-3);
}

TEST(ResidualFigure, IsNullWhereNothingIsValid) {
  Seen s = seen({0, 0}, 0.25);
  s.decoded.valid = Image<std::uint8_t>(40, 30);
  EXPECT_TRUE(residual_figure(s.decoded, s.points_world, s.projector, "c", "p").is_null());
}

TEST(ProjectionFigure, IsAPrincipalPointsShiftAndItsSigmaAtEveryDepth) {
  const Seen s = seen({0, 0}, 0.25);
  Device estimate = s.projector;
  estimate.intrinsics.cx += 2;
  std::vector<double> covariance(100);  // 10×10: fx, fy, cx, cy, pose
  covariance[22] = 9;
  const json p = projection_figure(s.projector, estimate, covariance,
                                   {s.points_world.values.begin(), s.points_world.values.end()});
  ASSERT_EQ(p["grid"].size(), 3u * 16 * 12);
  for (const json& cell : p["grid"]) {
    EXPECT_NEAR(std::abs(cell["du"].get<double>()), 2, 1e-9);
    EXPECT_NEAR(cell["dv"].get<double>(), 0, 1e-9);
    EXPECT_NEAR(cell["sigma_px"].get<double>(), 3, 1e-9);
  }
  for (const json& row : p["by_range"]) EXPECT_NEAR(row["error_rms_px"].get<double>(), 2, 1e-9);
}

}  // namespace
}  // namespace laterna
