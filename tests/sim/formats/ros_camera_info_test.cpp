#include "sim/formats/ros_camera_info.h"

#include "sim/formats/rig_file.h"
#include "tests/sim/formats/rigs.h"

#include <gmock/gmock.h>

#include <cmath>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::rig_pixel;

const char* const by_hand = R"(image_width: 640
image_height: 480
camera_name: projector_left
camera_matrix:
  rows: 3
  cols: 3
  data: [500.0, 0.0, 320.0, 0.0, 600.0, 240.0, 0.0, 0.0, 1.0]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [0.1, 0.0, 0.0, 0.0, 0.2]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
projection_matrix:
  rows: 3
  cols: 4
  data: [500.0, 0.0, 320.0, 0.0, 0.0, 600.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0]
)";

TEST(RosCameraInfo, ReadsAFileByHand) {
  const testing::ScratchFolder folder;
  const Rig rig = read_rig(testing::write_text(folder / "left.yaml", by_hand));
  ASSERT_EQ(rig.projectors.size(), 1u);
  const double radial = 1 + 0.1 * 0.05 + 0.2 * 0.05 * 0.05 * 0.05;  // r² = 0.01 + 0.04
  EXPECT_PIXEL(rig_pixel(rig, "projector_left", {0.1, 0.2, 1}), 320 + 500 * 0.1 * radial,
               240 + 600 * 0.2 * radial);
}

// A pixel of the equidistant model at θ = atan(0.5) along (3, 4)/5, under both of its names.
TEST(RosCameraInfo, ReadsAnEquidistantLensAsASpline) {
  const testing::ScratchFolder folder;
  for (const std::string name : {"equidistant", "fisheye"}) {
    SCOPED_TRACE(name);
    std::string text = by_hand;
    text.replace(text.find("plumb_bob"), 9, name);
    text.replace(text.find("cols: 5"), 7, "cols: 4");
    text.replace(text.find("[0.1, 0.0, 0.0, 0.0, 0.2]"), 25, "[0.05, 0.0, 0.0, -0.01]");
    const Rig rig = read_rig(testing::write_text(folder / (name + ".yaml"), text));
    const double t = std::atan(0.5), theta_d = t + 0.05 * std::pow(t, 3) - 0.01 * std::pow(t, 9);
    const glm::dvec2 pixel = rig_pixel(rig, "projector_left", {0.3, 0.4, 1});
    EXPECT_LT(glm::distance(pixel, glm::dvec2(320 + 500 * theta_d * 0.6, 240 + 600 * theta_d * 0.8)),
              0.002);  // what the fit promises
    ASSERT_EQ(rig.notes.size(), 1u);
    EXPECT_THAT(rig.notes[0], HasSubstr("lens of \"projector_left\": fisheye fitted by a spline"));
  }
}

// A stereo pair: the second stands 0.2 m to the right in the first's rectified frame (Tx = -f'·B = -400·0.2),
// and its own axes are turned by a quarter about z against that frame: x_rectified = R·x_device = (-y, x, z).
TEST(RosCameraInfo, ReadsWhereASecondDeviceStands) {
  std::string text = by_hand;
  text.replace(text.find("data: [1.0, 0.0, 0.0, 0.0, 1.0"), 51, "data: [0, -1, 0, 1, 0, 0, 0, 0, 1]");
  text.replace(text.find("data: [500.0, 0.0, 320.0, 0.0, 0.0"), 74,
               "data: [400, 0, 310, -80, 0, 400, 250, 0, 0, 0, 1, 0]");
  text.replace(text.find("[0.1, 0.0, 0.0, 0.0, 0.2]"), 25, "[0, 0, 0, 0, 0]");
  Notes notes;
  const Device device = parse_camera_info(text, "right.yaml", notes);
  // (0.1, 0.2, 1) is (-0.1, 0.2, 1) from it in rectified axes; x_device = Rᵀ·that = (0.2, 0.1, 1).
  const glm::dvec2 pixel = WorldProjection(device).project({0.1, 0.2, 1});
  EXPECT_PIXEL(pixel, 320 + 500 * 0.2, 240 + 600 * 0.1);
  EXPECT_LT(glm::distance(center_in_world(device.device_from_world), glm::dvec3(0.2, 0, 0)), 1e-15);
  text.replace(text.find("[400, 0, 310, -80"), 17, "[0, 0, 310, -80");
  EXPECT_THAT(testing::input_error([&] { parse_camera_info(text, "right.yaml", notes); }),
              HasSubstr("projection_matrix"));
}

TEST(RosCameraInfo, SurvivesARoundTripAsAFolder) {
  auto random = testing::generator();
  const testing::ScratchFolder folder;
  Rig rig = testing::random_pair(random, "LENSMODEL_OPENCV8", 8);
  for (auto* devices : {&rig.cameras, &rig.projectors}) devices->at(0).device_from_world = {};
  Notes notes;
  write_rig(folder / "rig", rig_texts(rig, folder / "rig", "ros", 1, notes));
  testing::expect_same(read_rig(folder / "rig"), rig, 0);
  EXPECT_EQ(notes.size(), 1u);  // no projectors
}

TEST(RosCameraInfo, SaysWhatItCannotHold) {
  auto random = testing::generator();
  Notes notes;
  Device device = testing::random_device(random, "left", "LENSMODEL_OPENCV5", 5);
  camera_info_text(device, notes);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_THAT(notes[0], HasSubstr("holds no placement"));
  device = testing::random_device(random, "left", "LENSMODEL_OPENCV12", 12);
  EXPECT_THAT(testing::input_error([&] { camera_info_text(device, notes); }), HasSubstr("at most 8"));
}

TEST(RosCameraInfo, BadFiles) {
  const auto error_of = [](const std::string& from, const std::string& to) {
    std::string text = by_hand;
    text.replace(text.find(from), from.size(), to);
    Notes notes;
    return testing::input_error([&] { parse_camera_info(text, "c.yaml", notes); });
  };
  EXPECT_THAT(error_of("plumb_bob", "fov"), HasSubstr("distortion_model: found \"fov\""));
  EXPECT_THAT(error_of("plumb_bob", "equidistant"),
              HasSubstr("distortion_coefficients.data: found 5 numbers, expected 4"));
  EXPECT_THAT(error_of("camera_matrix", "camera_matri"), HasSubstr("\"camera_matrix\" is missing"));
  EXPECT_THAT(error_of("640", "640.5"), HasSubstr("image_width: found \"640.5\", expected a whole number"));
}

}  // namespace
}  // namespace laterna
