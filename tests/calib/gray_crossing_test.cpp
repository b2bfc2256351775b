#include "calib/gray_crossing.h"

#include "calib/decode_gray.h"
#include "tests/calib/pictures.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>

namespace laterna {
namespace {

struct Errors {
  double whole_px, refined_px, sigma_px;  // rms of the 2-vector; sqrt(2)·rms of sigma
};

// Gray codes through a turned affine map, `zoom` camera pixels per projector pixel.
Errors errors(PatternKind kind, double zoom, double turn_rad, int samples, double noise_dn,
              std::mt19937_64& random) {
  const PatternSequence sequence{{.kind = kind}, {160, 160}};
  const glm::dmat2 turn(std::cos(turn_rad), std::sin(turn_rad), -std::sin(turn_rad), std::cos(turn_rad));
  const auto place = [&](glm::dvec2 p) { return turn * (p - 100.0) / zoom + glm::dvec2(80.13, 79.71); };
  const ImageStack<std::uint8_t> stack = seen(sequence, {200, 200}, samples, place, noise_dn, random);
  GrayDecodeOptions options;
  const DecodedMap whole = decode_gray(stack, sequence, options);
  options.subpixel = true;
  const DecodedMap refined = decode_gray(stack, sequence, options);
  EXPECT_EQ(whole.valid.values, refined.valid.values);
  double sum_whole = 0, sum_refined = 0, sigma2 = 0, n = 0;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      if (!whole.valid(x, y)) continue;
      const glm::dvec2 truth = place({x, y});
      const auto squared = [&](const DecodedMap& m) {
        const glm::dvec2 d = glm::dvec2(m.u_px(x, y), m.v_px(x, y)) - truth;
        return glm::dot(d, d);
      };
      sum_whole += squared(whole), sum_refined += squared(refined);
      sigma2 += 2 * std::pow(refined.sigma_px(x, y), 2), ++n;
    }
  }
  EXPECT_GT(n, 10000);
  return {std::sqrt(sum_whole / n), std::sqrt(sum_refined / n), std::sqrt(sigma2 / n)};
}

TEST(GrayCrossing, BeatsTheIntegerFloorWhereTheCameraResolvesIt) {
  auto random = testing::generator();
  for (const double turn : {0.07, 1.5, 3.3}) {
    for (const PatternKind kind : {PatternKind::gray, PatternKind::xor_gray}) {
      const Errors e = errors(kind, 3, turn, 6, 1.5, random);
      EXPECT_NEAR(e.whole_px, std::sqrt(2 / 12.0), 0.03);  // uniform rounding; edges' pixels are rejected
      EXPECT_LT(e.refined_px, 0.15);
      EXPECT_NEAR(e.sigma_px / e.refined_px, 1, 0.6);  // an edge's place is uniform or linear: no exact law
    }
  }
}

TEST(GrayCrossing, PointSamplesStillGain) {
  auto random = testing::generator();
  const Errors e = errors(PatternKind::gray, 3, 0.07, 1, 0, random);
  EXPECT_LT(e.refined_px, 0.6 * e.whole_px);
}

TEST(GrayCrossing, CoarseCamerasKeepWholeNumbers) {
  auto random = testing::generator();
  const Errors e = errors(PatternKind::gray, 0.8, 0.02, 1, 1, random);
  EXPECT_LE(e.refined_px, 1.05 * e.whole_px);
}

}  // namespace
}  // namespace laterna
