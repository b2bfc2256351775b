#include "sim/formats/kalibr.h"

#include "sim/formats/rig_file.h"
#include "tests/sim/formats/rigs.h"

#include <gmock/gmock.h>

#include <cmath>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::rig_pixel;

const char* const by_hand = R"(cam0:
  camera_model: pinhole
  distortion_coeffs: [0.1, 0.0, 0.0, 0.0]
  distortion_model: radtan
  intrinsics: [500.0, 600.0, 320.0, 240.0]
  resolution: [640, 480]
  rostopic: /left/image_raw
cam1:
  T_cn_cnm1:
  - [0.0, -1.0, 0.0, -0.2]
  - [1.0, 0.0, 0.0, 0.01]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  camera_model: pinhole
  distortion_coeffs: []
  distortion_model: none
  intrinsics: [2000.0, 2000.0, 512.0, 800.0]
  resolution: [1024, 768]
  rostopic: /projector/image_raw
cam2:
  T_cn_cnm1: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 1], [0, 0, 0, 1]]
  camera_model: pinhole
  distortion_coeffs: [0, 0, 0.01, 0]
  distortion_model: radtan
  intrinsics: [1000.0, 1000.0, 320.0, 240.0]
  resolution: [640, 480]
)";

TEST(Kalibr, ReadsAChainByHand) {
  const Rig rig = parse_kalibr(by_hand, "camchain.yaml");
  EXPECT_PIXEL(rig_pixel(rig, "left", {0.1, 0.2, 1}), 320 + 500 * 0.1 * 1.005, 240 + 600 * 0.2 * 1.005);
  ASSERT_EQ(rig.projectors.size(), 1u);
  // (-0.2 - 0.2, 0.1 + 0.01, 1).
  EXPECT_PIXEL(rig_pixel(rig, "projector", {0.1, 0.2, 1}), 512 - 2000 * 0.4, 800 + 2000 * 0.11);
  // One metre further along the chain: (-0.4, 0.11, 2); r1 adds 2·r1·x·y to x and r1·(r² + 2y²) to y.
  const double x = -0.2, y = 0.055, r2 = x * x + y * y;
  EXPECT_PIXEL(rig_pixel(rig, "cam2", {0.1, 0.2, 1}), 320 + 1000 * (x + 0.02 * x * y),
               240 + 1000 * (y + 0.01 * (r2 + 2 * y * y)));
}

// A pixel of OpenCV's fisheye model at θ = atan(0.5) along (3, 4)/5.
TEST(Kalibr, ReadsAnEquidistantLensAsASpline) {
  std::string text = by_hand;
  text.replace(text.find("[0.1, 0.0, 0.0, 0.0]"), 20, "[-0.01, 0.02, -0.03, 0.01]");
  text.replace(text.find("radtan"), 6, "equidistant");
  const Rig rig = parse_kalibr(text, "camchain.yaml");
  const double t = std::atan(0.5), t2 = t * t;
  const double theta_d =
      t * (1 - 0.01 * t2 + 0.02 * t2 * t2 - 0.03 * t2 * t2 * t2 + 0.01 * t2 * t2 * t2 * t2);
  const glm::dvec2 pixel = rig_pixel(rig, "left", {0.3, 0.4, 1});
  EXPECT_LT(glm::distance(pixel, glm::dvec2(320 + 500 * theta_d * 0.6, 240 + 600 * theta_d * 0.8)),
            0.002);  // what the fit promises
  ASSERT_EQ(rig.notes.size(), 1u);
  EXPECT_THAT(rig.notes[0], HasSubstr("lens of \"left\": fisheye fitted by a spline"));
  EXPECT_EQ(parse_kalibr(by_hand, "camchain.yaml").notes, Notes{});
  Notes notes;
  EXPECT_THAT(testing::input_error([&] { kalibr_text(rig, notes); }),
              HasSubstr("kalibr holds OpenCV's lenses only, \"left\" has LENSMODEL_SPLINED_STEREOGRAPHIC"));
}

TEST(Kalibr, AFileHasNoMoreThan16LensesToFit) {
  std::string text;
  for (int i = 0; i <= 16; ++i)
    text += "cam" + std::to_string(i) +
            ": {camera_model: pinhole, distortion_model: equidistant, distortion_coeffs: [0, 0, 0, 0], "
            "intrinsics: [99, 99, 8, 8], resolution: [16, 16], "
            "T_cn_cnm1: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}\n";
  EXPECT_THAT(testing::input_error([&] { parse_kalibr(text, "c.yaml"); }),
              HasSubstr("c.yaml: cam16.distortion_model: found \"equidistant\", expected no more than 16"));
}

TEST(Kalibr, SurvivesARoundTripRelativeToItsFirst) {
  auto random = testing::generator();
  Rig rig = testing::random_pair(random, "LENSMODEL_OPENCV4", 4);
  rig.cameras.push_back(testing::random_device(random, "right", "LENSMODEL_PINHOLE", 0));
  Notes notes;
  const Rig read = parse_kalibr(kalibr_text(rig, notes), "x");
  EXPECT_EQ(notes.size(), 2u);  // no projectors, no world
  Notes none;
  testing::expect_same(read, relative_to(rig, rig.cameras[0], "x", none),
                       1e-12);  // a chain of three products
}

std::string error_of(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  return testing::input_error([&] { parse_kalibr(text, "c.yaml"); });
}

TEST(Kalibr, BadFiles) {
  EXPECT_THAT(error_of(by_hand, "pinhole", "omni"), HasSubstr("cam0.camera_model: found \"omni\""));
  EXPECT_THAT(error_of(by_hand, "radtan", "fov"), HasSubstr("expected radtan, equidistant or none"));
  const std::string fisheye =
      std::string(by_hand).replace(std::string(by_hand).find("radtan"), 6, "equidistant");
  EXPECT_THAT(error_of(fisheye, "[500.0, 600.0, ", "[100.0, 100.0, "),
              HasSubstr("c.yaml: cam0: pixel (-0.5, -0.5) of the fisheye lens has no ray"));
  EXPECT_THAT(error_of(by_hand, "T_cn_cnm1", "T_cam_imu"), HasSubstr("cam1: \"T_cn_cnm1\" is missing"));
  EXPECT_THAT(error_of(by_hand, "[0.0, 0.0, 0.0, 1.0]", "[0.0, 0.0, 1.0, 1.0]"), HasSubstr("last row"));
  EXPECT_THAT(error_of(by_hand, "[640, 480]", "[640]"), HasSubstr("width and height"));
  EXPECT_THAT(error_of(by_hand, "cam0", "left"), HasSubstr("\"cam0\" is missing"));
  EXPECT_THAT(error_of(by_hand, "cam1:", "cam0:"), HasSubstr("c.yaml:8: a second \"cam0\""));
}

}  // namespace
}  // namespace laterna
