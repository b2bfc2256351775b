#include "calib/decode_quality.h"

#include "calib/decode_gray.h"
#include "sim/error.h"
#include "sim/image_file.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>

namespace laterna {
namespace {

// A homography of the camera's pixels, rounded or not.
DecodedMap homography_map(int width, int height, bool rounded) {
  DecodedMap map(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double w = 1 + 2e-4 * x - 1e-4 * y;
      const double u = (3.37 * x + 0.21 * y + 17) / w, v = (-0.4 * x + 3.11 * y + 400) / w;
      map.u_px(x, y) = rounded ? std::round(u) : u;
      map.v_px(x, y) = rounded ? std::round(v) : v;
      map.valid(x, y) = 1;
    }
  }
  return map;
}

TEST(DecodeQuality, AHomographyHasNoResidual) {
  EXPECT_NEAR(median_local_residual_px(homography_map(200, 150, false)), 0,
              1e-5);  // normal equations: √eps of 1e3 px
}

TEST(DecodeQuality, RoundingHasItsFloor) {
  // sqrt(2/12) for independent rounding; 8 parameters over 2·289 coordinates take off 0.7 %.
  EXPECT_NEAR(median_local_residual_px(homography_map(400, 300, true)), std::sqrt(2.0 / 12), 0.012);
}

TEST(DecodeQuality, TooLittleIsARefusal) {
  EXPECT_THROW(median_local_residual_px(DecodedMap(100, 100)), Refusal);
  EXPECT_THROW(median_local_residual_px(homography_map(100, 100, false), {1, 64}), InputError);
}

TEST(DecodeQuality, RealCaptureStaysUnderTheFloor) {
  const char* captures = std::getenv("LATERNA_CAPTURES");
  const auto folder = std::filesystem::path(captures ? captures : "") / "graycode-procam-kamino/capture_0";
  if (!captures || !std::filesystem::exists(folder)) {
    GTEST_SKIP() << "LATERNA_CAPTURES does not name a folder with graycode-procam-kamino/capture_0";
  }
  std::vector<std::filesystem::path> files;
  for (int k = 0; k < 42; ++k) files.push_back(folder / fmt::format("graycode_{:02}.png", k));
  const DecodedMap map = decode_gray(read_stack(files), {1024, 768});
  EXPECT_LE(median_local_residual_px(map), 0.38);  // its README measured 0.376 at the board's corners
  EXPECT_GT(median_local_residual_px(map), 0.30);  // integer codes cannot be much better
}

}  // namespace
}  // namespace laterna
