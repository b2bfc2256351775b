#include "sim/cameramodel_file.h"

#include "sim/error.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const char* const sound = R"(# made by hand
{
    'lensmodel':  'LENSMODEL_OPENCV5',
    'intrinsics': [ 1500.5, 1501.25, 639.5, 399.75, -0.05, 0.02, 0.001, -0.002, 0.003 ],
    'valid_intrinsics_region': [ [0, 0], [1279, 0], [1279, 799], [0, 0] ],
    'extrinsics': [ 0, 0, 1.5707963267948966, 0.1, -0.2, 1.5 ],
    'imagersize': [ 1280, 800 ],
    'icam_intrinsics': 0,
}
)";

TEST(CameramodelFile, ReadsAFileByHand) {
  const testing::ScratchFolder folder;
  const Device device = read_cameramodel(testing::write_text(folder / "left.cameramodel", sound));
  EXPECT_EQ(device.name, "left");
  EXPECT_EQ(device.intrinsics.size, glm::ivec2(1280, 800));
  EXPECT_EQ(device.intrinsics.fx, 1500.5);
  EXPECT_EQ(device.intrinsics.cy, 399.75);
  EXPECT_EQ(device.lens.model, "LENSMODEL_OPENCV5");
  EXPECT_EQ(device.lens.parameters, (std::vector<double>{-0.05, 0.02, 0.001, -0.002, 0.003}));
  // A quarter turn about z: the world's x is the device's y. 1e-15: rounding.
  const glm::dvec3 x = apply(device.device_from_world, glm::dvec3(1, 0, 0));
  EXPECT_NEAR(glm::distance(x, glm::dvec3(0.1, 0.8, 1.5)), 0, 1e-15);
}

TEST(CameramodelFile, SurvivesWritingAndReading) {
  auto random = testing::generator();
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 200; ++i) {
    Device device;
    device.intrinsics = {
        {640, 480}, 500 + uniform(random), 501 + uniform(random), 320 + uniform(random), 1000.0 / 3};
    device.lens = {"LENSMODEL_OPENCV4", {uniform(random) * 1e-2, uniform(random) * 1e-3, 1e-300, 0.0}};
    const glm::dvec3 axis(uniform(random), uniform(random), uniform(random));
    device.device_from_world =
        rigid_from_rotation_vector(axis * std::numbers::pi, {1.0 / 3, uniform(random), 1e6});
    const Device read = parse_cameramodel(cameramodel_text(device), "x");
    EXPECT_EQ(read.intrinsics.size, device.intrinsics.size);
    EXPECT_EQ(read.intrinsics.fx, device.intrinsics.fx);
    EXPECT_EQ(read.intrinsics.fy, device.intrinsics.fy);
    EXPECT_EQ(read.intrinsics.cx, device.intrinsics.cx);
    EXPECT_EQ(read.intrinsics.cy, device.intrinsics.cy);
    EXPECT_EQ(read.lens, device.lens);
    EXPECT_EQ(read.device_from_world.translation, device.device_from_world.translation);
    for (int c = 0; c < 3; ++c) {
      // 1e-14: matrix to Rodrigues vector and back is a dozen roundings.
      EXPECT_NEAR(glm::distance(read.device_from_world.rotation[c], device.device_from_world.rotation[c]), 0,
                  1e-14);
    }
  }
}

// By hand: u = fx·2·tan(θ/2)·x/r + cx. Of (3, 4, 0)·sin 60° + (0, 0, 5)·cos 60°, tan 30° = 1/√3.
TEST(CameramodelFile, ReadsAStereographicLensByHand) {
  std::string text = sound;
  text.replace(text.find("LENSMODEL_OPENCV5"), 17, "LENSMODEL_STEREOGRAPHIC");
  text.replace(text.find(", -0.05, 0.02, 0.001, -0.002, 0.003"), 35, "");
  text.replace(text.find("[ 0, 0, 1.5707963267948966, 0.1, -0.2, 1.5 ]"), 44, "[ 0, 0, 0, 0, 0, 0 ]");
  const Device device = parse_cameramodel(text, "x.cameramodel");
  const double s = std::sqrt(3.0) / 2;
  const auto pixel = LensProjection(device.intrinsics, device.lens).project({3 * s, 4 * s, 2.5});
  ASSERT_TRUE(pixel);
  // 1e-9 px: a few roundings of thousands of pixels.
  EXPECT_NEAR(pixel->x, 639.5 + 1500.5 * 2 / std::sqrt(3.0) * 0.6, 1e-9);
  EXPECT_NEAR(pixel->y, 399.75 + 1501.25 * 2 / std::sqrt(3.0) * 0.8, 1e-9);
}

TEST(CameramodelFile, EveryLensModelSurvives) {
  auto random = testing::generator();
  std::uniform_real_distribution<double> uniform(-1e-3, 1e-3);
  for (const std::string model :
       {"LENSMODEL_PINHOLE", "LENSMODEL_STEREOGRAPHIC", "LENSMODEL_OPENCV4", "LENSMODEL_OPENCV5",
        "LENSMODEL_OPENCV8", "LENSMODEL_OPENCV12", "LENSMODEL_CAHVOR",
        "LENSMODEL_SPLINED_STEREOGRAPHIC_order=3_Nx=6_Ny=5_fov_x_deg=60"}) {
    Device device;
    device.name = "x";
    device.intrinsics = {{640, 480}, 800.25, 801, 1.0 / 3, 240};
    device.lens.model = model;
    for (int i = 0; i < lens_parameter_count(model); ++i) device.lens.parameters.push_back(uniform(random));
    EXPECT_EQ(parse_cameramodel(cameramodel_text(device), "x").lens, device.lens) << model;
  }
}

std::string error_of(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  return testing::input_error([&] { parse_cameramodel(text, "c.cameramodel"); });
}

TEST(CameramodelFile, BadFiles) {
  EXPECT_THAT(error_of(sound, "'imagersize': [ 1280, 800 ],", ""), StartsWith("c.cameramodel: "));
  EXPECT_THAT(error_of(sound, "1280, 800 ]", "0, 800 ]"), StartsWith("c.cameramodel: "));
  EXPECT_THAT(error_of(sound, "1280, 800 ]", "4294967295, 800 ]"), StartsWith("c.cameramodel: "));
  EXPECT_THAT(error_of(sound, "1500.5", "-3"), HasSubstr("focal length"));
  EXPECT_THAT(error_of(sound, "1500.5", "nan"), StartsWith("c.cameramodel: "));
  EXPECT_THAT(error_of(sound, "-0.05", "1e999"), StartsWith("c.cameramodel: "));
  EXPECT_THAT(error_of(sound, "1.5707963267948966", "1e200"), StartsWith("c.cameramodel: "));
  EXPECT_THAT(error_of(sound, "OPENCV5", "OPENCV8"), StartsWith("c.cameramodel: "));
  EXPECT_THAT(error_of(sound, "LENSMODEL_OPENCV5", "FISH"), StartsWith("c.cameramodel: "));
  EXPECT_THAT(error_of(sound, "made by hand", "\xff"), HasSubstr("UTF-8"));
  EXPECT_THAT(error_of(sound, "made by hand", std::string(1, '\0')), HasSubstr("0x00"));
  EXPECT_THAT(testing::input_error([] { parse_cameramodel("", "empty"); }), StartsWith("empty: "));
  EXPECT_THAT(testing::input_error([] { read_cameramodel("/nowhere/c.cameramodel"); }),
              HasSubstr("No such file"));
}

TEST(CameramodelFile, BytesFlippedAtRandomAreReadOrRefused) {
  auto random = testing::generator();
  int read = 0, refused = 0;
  ::testing::internal::CaptureStderr();  // mrcal's parser reports there
  for (int i = 0; i < 300; ++i) {
    std::string text = sound;
    for (int flips = 1 + int(random() % 3); flips > 0; --flips)
      text[random() % text.size()] = char(32 + random() % 95);
    try {
      parse_cameramodel(text, "c");
      ++read;
    } catch (const InputError&) {
      ++refused;
    }
  }
  ::testing::internal::GetCapturedStderr();
  EXPECT_GT(read, 20);
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace laterna
