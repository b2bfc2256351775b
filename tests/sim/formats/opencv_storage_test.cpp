#include "sim/formats/opencv_storage.h"

#include "sim/formats/rig_file.h"
#include "tests/sim/formats/rigs.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::rig_pixel;

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

// As OpenCV writes: single precision (dt f) as SLStudio's Matx33f gives, data over lines.
TEST(OpencvStorage, ReadsSlstudioByHand) {
  const std::string by_hand = R"(<?xml version="1.0"?>
<opencv_storage>
<Kc type_id="opencv-matrix">
  <rows>3</rows>
  <cols>3</cols>
  <dt>f</dt>
  <data>
    1000. 0. 320. 0. 1100. 240. 0. 0.
    1.</data></Kc>
<kc type_id="opencv-matrix">
  <rows>5</rows>
  <cols>1</cols>
  <dt>f</dt>
  <data>
    0. 0. 0. 0. 0.5</data></kc>
<Kp type_id="opencv-matrix"> <rows>3</rows> <cols>3</cols> <dt>f</dt>
  <data> 2000. 0. 512. 0. 2000. 800. 0. 0. 1.</data></Kp>
<kp type_id="opencv-matrix"> <rows>5</rows> <cols>1</cols> <dt>f</dt> <data> 0. 0. 0. 0. 0.</data></kp>
<Rp type_id="opencv-matrix"> <rows>3</rows> <cols>3</cols> <dt>f</dt> <data> 0. -1. 0. 1. 0. 0. 0. 0. 1.</data></Rp>
<Tp type_id="opencv-matrix"> <rows>3</rows> <cols>1</cols> <dt>f</dt> <data> -200. 10. 0.</data></Tp>
<cam_error>2.5e-01</cam_error>
<frameWidth>640</frameWidth>
<frameHeight>480</frameHeight>
<screenResX>912</screenResX>
<screenResY>1140</screenResY>
</opencv_storage>
)";
  const testing::ScratchFolder folder;
  const Rig rig =
      read_rig(testing::write_text(folder / "calibration.xml", by_hand), {"", 0.001, {0, 0}, {0, 0}});
  EXPECT_EQ(rig.cameras.at(0).intrinsics.size, glm::ivec2(640, 480));
  EXPECT_EQ(rig.projectors.at(0).intrinsics.size, glm::ivec2(912, 1140));
  const double radial = 1 + 0.5 * 0.05 * 0.05 * 0.05;  // the fifth is k3, of r⁶; r² = 0.05
  EXPECT_PIXEL(rig_pixel(rig, "camera", {0.1, 0.2, 1}), 320 + 1000 * 0.1 * radial, 240 + 1100 * 0.2 * radial);
  EXPECT_PIXEL(rig_pixel(rig, "projector", {0.1, 0.2, 1}), 512 - 2000 * 0.4, 800 + 2000 * 0.11);
}

// OpenCV's stereo sample: two files, fourteen coefficients (rational and thin prism, the sensor not tilted).
TEST(OpencvStorage, ReadsTheStereoSamplesTwoFiles) {
  const char* const intrinsics = R"(%YAML:1.0
---
M1: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 500., 0., 320., 0., 500., 240., 0., 0., 1. ]
D1: !!opencv-matrix
   rows: 1
   cols: 14
   dt: d
   data: [ 0.1, 0., 0., 0., 0., 0.2, 0., 0.,
       0.01, 0., 0., 0.03, 0., 0. ]
M2: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 600., 0., 300., 0., 600., 200., 0., 0., 1. ]
D2: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ 0., 0., 0., 0., 0. ]
)";
  const char* const extrinsics = R"(%YAML:1.0
---
R: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ]
T: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [ -3., 0., 0. ]
R1: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ]
)";
  const testing::ScratchFolder folder;
  const auto file = testing::write_text(folder / "intrinsics.yml", intrinsics);
  const RigReadOptions centimetres{"", 0.01, {640, 480}, {640, 480}};
  EXPECT_THAT(testing::input_error([&] { read_rig(file, centimetres); }),
              HasSubstr(" is missing"));  // R or T
  testing::write_text(folder / "extrinsics.yml", extrinsics);
  const Rig rig = read_rig(file, centimetres);
  // x = 0.1, y = 0.2, r² = 0.05: (1 + 0.1·r²)/(1 + 0.2·r²), and thin prisms s1·r² of x, s4·r⁴ of y.
  const double r2 = 0.05, radial = (1 + 0.1 * r2) / (1 + 0.2 * r2);
  EXPECT_PIXEL(rig_pixel(rig, "camera", {0.1, 0.2, 1}), 320 + 500 * (0.1 * radial + 0.01 * r2),
               240 + 500 * (0.2 * radial + 0.03 * r2 * r2));
  EXPECT_PIXEL(rig_pixel(rig, "projector", {0.1, 0.2, 1}), 300 + 600 * (0.1 - 0.03), 200 + 600 * 0.2);
}

TEST(OpencvStorage, ReadsListsInXmlByHand) {
  const std::string by_hand = R"(<?xml version="1.0"?>
<opencv_storage>
<Projectors>
  <_>
    <name>"projector 1"</name>
    <size>1024 768</size>
    <K type_id="opencv-matrix"> <rows>3</rows> <cols>3</cols> <dt>d</dt>
      <data> 2000. 0. 512. 0. 2000. 800. 0. 0. 1.</data></K>
    <D type_id="opencv-matrix"> <rows>1</rows> <cols>4</cols> <dt>d</dt> <data> 0.1 0. 0. 0.</data></D>
    <R type_id="opencv-matrix"> <rows>3</rows> <cols>3</cols> <dt>d</dt> <data> 0. -1. 0. 1. 0. 0. 0. 0. 1.</data></R>
    <T type_id="opencv-matrix"> <rows>3</rows> <cols>1</cols> <dt>d</dt> <data> -0.2 0.01 0.</data></T></_></Projectors>
</opencv_storage>
)";
  const testing::ScratchFolder folder;
  const Rig rig = read_rig(testing::write_text(folder / "rig.xml", by_hand));
  const double radial = 1 + 0.1 * (0.4 * 0.4 + 0.11 * 0.11);
  EXPECT_PIXEL(rig_pixel(rig, "projector 1", {0.1, 0.2, 1}), 512 - 2000 * 0.4 * radial,
               800 + 2000 * 0.11 * radial);
}

TEST(OpencvStorage, ReadsTheCalibrationSampleOldAndNew) {
  const std::string now = R"(%YAML:1.0
---
calibration_time: "Fri 27 Nov 2026"
image_width: 640
image_height: 480
fisheye_model: 0
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 500., 0., 320., 0., 600., 240., 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ 0.1, 0., 0., 0., 0. ]
)";
  const std::string before = R"(<?xml version="1.0"?>
<opencv_storage>
<image_Width>640</image_Width>
<image_Height>480</image_Height>
<Camera_Matrix type_id="opencv-matrix"> <rows>3</rows> <cols>3</cols> <dt>d</dt>
  <data> 500. 0. 320. 0. 600. 240. 0. 0. 1.</data></Camera_Matrix>
<Distortion_Coefficients type_id="opencv-matrix"> <rows>5</rows> <cols>1</cols> <dt>d</dt>
  <data> 0.1 0. 0. 0. 0.</data></Distortion_Coefficients>
</opencv_storage>
)";
  const testing::ScratchFolder folder;
  for (const auto& [name, text] : {std::pair("now.yml", now), std::pair("before.xml", before)}) {
    const Rig rig = read_rig(testing::write_text(folder / name, text));
    EXPECT_EQ(rig.cameras.at(0).intrinsics.size, glm::ivec2(640, 480)) << name;
    EXPECT_PIXEL(rig_pixel(rig, "camera", {0.1, 0.2, 1}), 320 + 500 * 0.1 * 1.005, 240 + 600 * 0.2 * 1.005);
  }
}

// A pixel of OpenCV's fisheye model at θ = atan(0.5) along (3, 4)/5.
TEST(OpencvStorage, ReadsAFisheyeOfTheCalibrationSampleAsASpline) {
  const std::string by_hand = R"(%YAML:1.0
---
image_width: 640
image_height: 480
fisheye_model: 1
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 500., 0., 320., 0., 600., 240., 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 4
   cols: 1
   dt: d
   data: [ 0.05, 0., 0., -0.01 ]
)";
  const testing::ScratchFolder folder;
  const Rig rig = read_rig(testing::write_text(folder / "camera.yml", by_hand));
  const double t = std::atan(0.5), theta_d = t + 0.05 * std::pow(t, 3) - 0.01 * std::pow(t, 9);
  const glm::dvec2 pixel = rig_pixel(rig, "camera", {0.3, 0.4, 1});
  EXPECT_LT(glm::distance(pixel, glm::dvec2(320 + 500 * theta_d * 0.6, 240 + 600 * theta_d * 0.8)),
            0.002);  // what the fit promises
  ASSERT_EQ(rig.notes.size(), 1u);
  EXPECT_THAT(rig.notes[0], HasSubstr("lens of \"camera\": fisheye fitted by a spline"));
  Notes notes;
  EXPECT_THAT(testing::input_error([&] { opencv_storage_text(rig, "opencv", notes); }),
              HasSubstr("OpenCV's storage holds OpenCV's lenses only"));
  std::string unsized = by_hand;
  unsized.erase(unsized.find("image_width"), 17);
  EXPECT_THAT(testing::input_error([&] { parse_opencv_storage(unsized, "c.yml"); }),
              HasSubstr("c.yml: distortion_coefficients: size is 0 × 0"));
}

// pixel_projectorᵀ·F·pixel_camera = 0 and x_projectorᵀ·E·x_camera = 0: without both, scan3d-capture takes no
// file.
TEST(OpencvStorage, Scan3dHasItsEpipolarMatrices) {
  auto random = testing::generator();
  Rig rig = testing::random_pair(random, "LENSMODEL_PINHOLE", 0);
  rig.cameras[0].device_from_world = {};
  Notes notes;
  const Tree tree = yaml_tree(opencv_storage_text(rig, "scan3d", notes), "x");
  const auto matrix = [&](const char* key) {
    const Place place{&tree, ""};
    const std::vector<double> m = place.at(key).at("data").numbers(9);
    return glm::transpose(glm::dmat3(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]));
  };
  const glm::dvec3 x_camera(0.1, 0.2, 1.3),
      x_projector = apply(rig.projectors[0].device_from_world, x_camera);
  const glm::dvec3 c(rig_pixel(rig, "camera", x_camera), 1), p(rig_pixel(rig, "projector", x_camera), 1);
  const glm::dvec3 line = matrix("F") * c;
  // 1e-9 px from the line: a few roundings of thousands of pixels; of metres, 1e-14.
  EXPECT_LT(std::abs(glm::dot(p, line)) / glm::length(glm::dvec2(line)), 1e-9);
  EXPECT_LT(std::abs(glm::dot(x_projector, matrix("E") * x_camera)), 1e-14);
  EXPECT_GT(glm::length(matrix("E") * x_camera), 0.01);
}

TEST(OpencvStorage, SlstudioHasJustFiveCoefficients) {
  auto random = testing::generator();
  Rig rig = testing::random_pair(random, "LENSMODEL_OPENCV4", 4);
  rig.cameras[0].device_from_world = {};
  Notes notes;
  const Rig read = parse_opencv_storage(opencv_storage_text(rig, "slstudio", notes), "x");
  std::vector<double> five = rig.projectors[0].lens.parameters;
  five.push_back(0);
  EXPECT_EQ(read.projectors.at(0).lens, (Lens{"LENSMODEL_OPENCV5", five}));
  rig = testing::random_pair(random, "LENSMODEL_OPENCV8", 8);
  EXPECT_THAT(testing::input_error([&] { opencv_storage_text(rig, "slstudio", notes); }),
              HasSubstr("SLStudio holds at most 5 distortion coefficients"));
}

TEST(OpencvStorage, EveryLayoutSurvivesARoundTrip) {
  auto random = testing::generator();
  for (const char* layout : {"opencv", "scan3d", "procam", "slstudio", "opencv-stereo"}) {
    SCOPED_TRACE(layout);
    const int terms = layout == std::string("slstudio") ? 5 : 8;
    Rig rig = testing::random_pair(random, "LENSMODEL_OPENCV" + std::to_string(terms), terms);
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
  for (const char* height : {"777777777800", "480.5"})
    EXPECT_THAT(error_of(scan3d_by_hand, "cam_K", fmt::format("cam_size: [ 640, {} ]\ncam_K", height)),
                HasSubstr("expected whole numbers of pixels"));
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
