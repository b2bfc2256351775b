#include "sim/formats/colmap.h"

#include "sim/formats/rig_file.h"
#include "tests/sim/formats/rigs.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::rig_pixel;

// The camera is turned by half a turn about x: (x, y, z) becomes (x, -y, -z), then moved by (0, 0, 5).
const char* const cameras =
    "# Camera list\n1 PINHOLE 640 480 500 600 320.5 240.5\n2 SIMPLE_RADIAL 640 480 1000 320 240 0.1\n";
const char* const images =
    "# Image list\n1 0 1 0 0 0 0 5 1 left.png\n10.5 20.5 -1\n2 1 0 0 0 0.5 0 0 2 projector0.png\n\n";

TEST(Colmap, ReadsTextsByHand) {
  const Rig rig = parse_colmap(cameras, images, "model");
  ASSERT_EQ(rig.cameras.size(), 1u);
  // (1, 0.4, 1) becomes (1, -0.4, 4); COLMAP's pixel is 500/4 + 320.5 = 445.5 where centres are at halves:
  // here 445.
  EXPECT_PIXEL(rig_pixel(rig, "left", {1, 0.4, 1}), 445, 240.5 - 600 * 0.1 - 0.5);
  // (0.5, 0, 1): r² = 0.25, 1 + 0.1·0.25 = 1.025.
  EXPECT_PIXEL(rig_pixel(rig, "projector0", {0, 0, 1}), 319.5 + 1000 * 0.5 * 1.025, 239.5);
}

// Distortion terms in COLMAP's order: k1, k2, p1, p2, then k3 to k6; a rig's cameras are folders of pictures.
TEST(Colmap, ReadsOpencvModelsByHand) {
  const Rig rig = parse_colmap(
      "1 OPENCV 640 480 500 600 320.5 240.5 0.1 0.2 0.01 0.02\n"
      "2 FULL_OPENCV 640 480 500 600 320.5 240.5 0 0 0.01 0 0.3 0.4 0.5 0.6\n"
      "3 RADIAL 640 480 500 320.5 240.5 0.1 0.2\n4 SIMPLE_PINHOLE 640 480 500 320.5 240.5\n",
      // Half of the half angle: a quarter turn about z takes (x, y, z) to (-y, x, z).
      "1 0.7071067811865476 0 0 0.7071067811865476 0 0 0 1 left/0001.png\n\n"
      "2 1 0 0 0 0 0 0 2 right/0001.png\n\n3 1 0 0 0 0 0 0 3 radial.png\n\n4 1 0 0 0 0 0 0 4 simple.png\n\n",
      "model");
  double x = -0.2, y = 0.1;  // of (0.1, 0.2, 1), turned
  const double r2 = 0.05, radial = 1 + 0.1 * r2 + 0.2 * r2 * r2;
  EXPECT_PIXEL(rig_pixel(rig, "left_0001", {0.1, 0.2, 1}),
               320 + 500 * (x * radial + 2 * 0.01 * x * y + 0.02 * (r2 + 2 * x * x)),
               240 + 600 * (y * radial + 0.01 * (r2 + 2 * y * y) + 2 * 0.02 * x * y));
  x = 0.1, y = 0.2;
  const double rational = (1 + 0.3 * r2 * r2 * r2) / (1 + 0.4 * r2 + 0.5 * r2 * r2 + 0.6 * r2 * r2 * r2);
  EXPECT_PIXEL(rig_pixel(rig, "right_0001", {0.1, 0.2, 1}), 320 + 500 * (x * rational + 2 * 0.01 * x * y),
               240 + 600 * (y * rational + 0.01 * (r2 + 2 * y * y)));
  EXPECT_PIXEL(rig_pixel(rig, "radial", {0.1, 0.2, 1}), 320 + 500 * x * radial, 240 + 500 * y * radial);
  EXPECT_PIXEL(rig_pixel(rig, "simple", {0.1, 0.2, 1}), 320 + 500 * x, 240 + 500 * y);
}

TEST(Colmap, SurvivesARoundTrip) {
  auto random = testing::generator();
  const testing::ScratchFolder folder;
  for (const int terms : {0, 4, 8}) {
    const Rig rig = testing::random_pair(
        random, terms ? "LENSMODEL_OPENCV" + std::to_string(terms) : "LENSMODEL_PINHOLE", terms);
    Notes notes;
    const auto path = folder / ("model" + std::to_string(terms));
    write_rig(path, rig_texts(rig, path, "colmap", 1, notes));
    testing::expect_same(read_rig(path), rig, 1e-12);  // half a pixel added and taken, rotation by quaternion
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_THAT(notes[0], HasSubstr("knows no projectors"));
  }
}

TEST(Colmap, BadTexts) {
  const auto error = [](const std::string& c, const std::string& i) {
    return testing::input_error([&] { parse_colmap(c, i, "m"); });
  };
  EXPECT_THAT(error("1 FISHEYE 640 480 1 1 1\n", images), HasSubstr("m/cameras.txt:1: model FISHEYE"));
  EXPECT_THAT(error("1 PINHOLE 640 480 1 1 1\n", images), HasSubstr("3 parameters of PINHOLE, expected 4"));
  EXPECT_THAT(error("1 PINHOLE 640 21793109700 1 1 1 1\n", images),
              HasSubstr("found \"21793109700\", expected a whole number"));
  EXPECT_THAT(error("1 PINHOLE 640\n", images), HasSubstr("expected CAMERA_ID"));
  EXPECT_THAT(error(cameras, "1 0 1 0 0 0 0 5 7 left.png\n"), HasSubstr("m/images.txt:1: camera 7"));
  EXPECT_THAT(error(cameras, "1 0 0 0 0 0 0 5 1 left.png\n"), HasSubstr("quaternion"));
  EXPECT_THAT(error(cameras, "1 0 1 x 0 0 0 5 1 left.png\n"), HasSubstr("found \"x\", expected a number"));
  auto random = testing::generator();
  Notes notes;
  EXPECT_THAT(testing::input_error(
                  [&] { colmap_text(testing::random_pair(random, "LENSMODEL_OPENCV12", 12), notes); }),
              HasSubstr("at most 8"));
}

}  // namespace
}  // namespace laterna
