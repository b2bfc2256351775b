#include "sim/formats/ros_camera_info.h"

#include "sim/formats/rig_file.h"
#include "tests/sim/formats/rigs.h"

#include <gmock/gmock.h>

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
    return testing::input_error([&] { parse_camera_info(text, "c.yaml"); });
  };
  EXPECT_THAT(error_of("plumb_bob", "fisheye"), HasSubstr("distortion_model: found \"fisheye\""));
  EXPECT_THAT(error_of("camera_matrix", "camera_matri"), HasSubstr("\"camera_matrix\" is missing"));
  EXPECT_THAT(error_of("640", "640.5"), HasSubstr("image_width: found \"640.5\", expected a whole number"));
}

}  // namespace
}  // namespace laterna
