#include "sim/formats/opencv_storage.h"

#include "sim/formats/rig_file.h"
#include "tests/sim/formats/rigs.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::rig_pixel;
using ::testing::StartsWith;

// As scan3d-capture writes: the projector stands 200 mm to the right (its frame's x is the camera's minus
// 200) and is turned a quarter about z, so that x_projector = (-y, x, z) + T.
const char* const scan3d_by_hand = R"(%YAML:1.0
---
cam_K: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1000., 0., 320., 0., 1100., 240., 0., 0., 1. ]
cam_kc: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ 1.0e-01, 0., 0., 0., 0. ]
proj_K: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 2000., 0., 512., 0., 2000., 800., 0., 0., 1. ]
proj_kc: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ 0., 0., 0., 0., 0. ]
R: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 0., -1., 0., 1., 0., 0., 0., 0., 1. ]
T: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [ -200., 10., 0. ]
cam_error: 3.1e-01
)";

RigReadOptions millimetres() { return {"", 0.001, {640, 480}, {1024, 768}}; }

TEST(OpencvStorage, ReadsScan3dByHand) {
  const testing::ScratchFolder folder;
  const Rig rig = read_rig(testing::write_text(folder / "calibration.yml", scan3d_by_hand), millimetres());
  // The point (100, 200, 1000) mm: x/z = 0.1, y/z = 0.2, r² = 0.05, 1 + k1·r² = 1.005.
  EXPECT_PIXEL(rig_pixel(rig, "camera", {0.1, 0.2, 1}), 320 + 1000 * 0.1 * 1.005, 240 + 1100 * 0.2 * 1.005);
  // In the projector's frame (-200 - 200, 100 + 10, 1000) mm.
  EXPECT_PIXEL(rig_pixel(rig, "projector", {0.1, 0.2, 1}), 512 - 2000 * 0.4, 800 + 2000 * 0.11);
}

TEST(OpencvStorage, ReadsProcamCalibrationByHand) {
  const std::string by_hand = R"(<?xml version="1.0"?>
<opencv_storage>
<img_shape type_id="opencv-matrix"> <rows>2</rows> <cols>1</cols> <dt>d</dt> <data> 480. 640.</data></img_shape>
<rms>4.25e-01</rms>
<cam_int type_id="opencv-matrix"> <rows>3</rows> <cols>3</cols> <dt>d</dt>
  <data> 1.0e+03 0. 320. 0. 1000. 240. 0. 0. 1.</data></cam_int>
<cam_dist type_id="opencv-matrix"> <rows>1</rows> <cols>5</cols> <dt>d</dt> <data> 0. 0. 0. 0. 0.</data></cam_dist>
<proj_int type_id="opencv-matrix"> <rows>3</rows> <cols>3</cols> <dt>d</dt>
  <data> 2000. 0. 512. 0. 2000. 800. 0. 0. 1.</data></proj_int>
<proj_dist type_id="opencv-matrix"> <rows>1</rows> <cols>5</cols> <dt>d</dt> <data> 0. 0. 0. .05 0.</data></proj_dist>
<roration type_id="opencv-matrix"> <rows>3</rows> <cols>3</cols> <dt>d</dt>
  <data> 0. -1. 0. 1. 0. 0. 0. 0. 1.</data></roration>
<translation type_id="opencv-matrix"> <rows>3</rows> <cols>1</cols> <dt>d</dt> <data> -20. 1. 0.</data></translation>
</opencv_storage>
)";
  const testing::ScratchFolder folder;
  const Rig rig = read_rig(testing::write_text(folder / "calibration_result.xml", by_hand),
                           {"", 0.01, {0, 0}, {1024, 768}});
  EXPECT_EQ(rig.cameras.at(0).intrinsics.size, glm::ivec2(640, 480));  // height first in the file
  // x/z = -0.4, y/z = 0.11, r² = 0.1721; p2 adds p2·(r² + 2x²) to x and 2·p2·x·y to y.
  EXPECT_PIXEL(rig_pixel(rig, "projector", {0.1, 0.2, 1}), 512 + 2000 * (-0.4 + 0.05 * (0.1721 + 0.32)),
               800 + 2000 * (0.11 + 2 * 0.05 * -0.4 * 0.11));
}

TEST(OpencvStorage, EveryLayoutSurvivesARoundTrip) {
  auto random = testing::generator();
  for (const char* layout : {"opencv", "scan3d", "procam", "slstudio", "opencv-stereo"}) {
    SCOPED_TRACE(layout);
    Rig rig = testing::random_pair(random, "LENSMODEL_OPENCV8", 8);
    if (std::string(layout) != "opencv") rig.cameras[0].device_from_world = {};
    Notes notes;
    const Rig read = parse_opencv_storage(opencv_storage_text(rig, layout, notes), layout);
    EXPECT_EQ(notes, Notes{});
    testing::expect_same(read, rig, 1e-12);  // rounding: a rotation is taken as it stands
  }
}

TEST(OpencvStorage, APairBecomesRelativeToItsCameraAndSaysSo) {
  auto random = testing::generator();
  const Rig rig = testing::random_pair(random, "LENSMODEL_OPENCV5", 5);
  Notes notes;
  const Rig read = parse_opencv_storage(opencv_storage_text(rig, "scan3d", notes), "x");
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_THAT(notes[0], HasSubstr("relative to \"camera\""));
  const glm::dvec3 x_world(0.1, 0.2, 1.3);
  const glm::dvec3 x_camera = apply(rig.cameras[0].device_from_world, x_world);
  // 1e-9 px: a few roundings of thousands of pixels.
  EXPECT_LT(glm::distance(rig_pixel(read, "projector", x_camera), rig_pixel(rig, "projector", x_world)),
            1e-9);
}

std::string error_of(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  const testing::ScratchFolder folder;
  return testing::input_error([&] { read_rig(testing::write_text(folder / "c.yml", text), millimetres()); });
}

TEST(OpencvStorage, BadFiles) {
  EXPECT_THAT(error_of(scan3d_by_hand, "1000., 0., 320.", "1000., 3., 320."),
              HasSubstr("cam_K: a skew of 3 px"));
  EXPECT_THAT(error_of(scan3d_by_hand, "proj_K", "proj_k"), HasSubstr("\"proj_K\" is missing"));
  EXPECT_THAT(error_of(scan3d_by_hand, "0., -1., 0., 1.", "0., -1., 0., 2."),
              HasSubstr("expected a rotation"));
  EXPECT_THAT(error_of(scan3d_by_hand, "0., -1., 0., 1.", "0., 1., 0., 1."),
              HasSubstr("expected a rotation"));
  EXPECT_THAT(error_of(scan3d_by_hand, "-200.", ".nan"),
              HasSubstr("T.data[0]: found \".nan\", expected a finite"));
  EXPECT_THAT(error_of(scan3d_by_hand, "[ -200., 10., 0. ]", "[ 1, 2 ]"),
              HasSubstr("found 2 numbers, expected 3"));
  EXPECT_THAT(error_of(scan3d_by_hand, "rows: 5\n   cols: 1\n   dt: d\n   data: [ 1.0e-01, 0., 0., 0., 0. ]",
                       "rows: 6\n   cols: 1\n   data: [ 1, 2, 3, 4, 5, 6 ]"),
              HasSubstr("6 coefficients"));
  EXPECT_THAT(error_of(scan3d_by_hand, "data: [ 1000.", "data: *here #"), HasSubstr("c.yml:7: "));
  EXPECT_THAT(error_of(scan3d_by_hand, "cam_K", "lens"), HasSubstr("no calibration that is known"));
  EXPECT_THAT(error_of(scan3d_by_hand, "cam_error", std::string(2000, '[')), HasSubstr("nest deeper"));
  const testing::ScratchFolder folder;
  const auto file = testing::write_text(folder / "c.yml", scan3d_by_hand);
  EXPECT_THAT(testing::input_error([&] { read_rig(file); }), HasSubstr("--camera-size"));
}

TEST(OpencvStorage, WhatItCannotHoldIsRefused) {
  auto random = testing::generator();
  Rig rig = testing::random_pair(random, "LENSMODEL_OPENCV5", 5);
  Notes notes;
  rig.projectors[0].lens = {"LENSMODEL_STEREOGRAPHIC", {}};
  EXPECT_THAT(testing::input_error([&] { opencv_storage_text(rig, "opencv", notes); }),
              HasSubstr("STEREOGRAPHIC"));
  rig.projectors.clear();
  EXPECT_THAT(testing::input_error([&] { opencv_storage_text(rig, "procam", notes); }),
              HasSubstr("one camera and one projector, found 1 and 0"));
}

}  // namespace
}  // namespace laterna
