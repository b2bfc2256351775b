#include "sim/formats/exr_camera.h"

#include "sim/formats/rig_file.h"
#include "sim/text_file.h"
#include "tests/sim/formats/rigs.h"

#include <gmock/gmock.h>

#include <array>
#include <cstring>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using Matrix = std::array<float, 16>;

// By hand, in OpenEXR's convention. The camera stands at the world's (1, 2, 3) and looks along the world's
// +x; up is +z, so that right is -y: x_camera = 2 - y, y_camera = z - 3 (up), z_camera = x - 1 (forward). A
// row vector (x, y, z, 1) times these rows:
const Matrix to_camera = {0,  0,  1,  0,  //
                          -1, 0,  0,  0,  //
                          0,  1,  0,  0,  //
                          2,  -3, -1, 1};
// 8 × 4 pixels, the window 2 wide and 1 high at depth 1, its left edge 0.75 left of the axis, its upper edge
// 0.5 above: x' = (x_camera + 0.75·z_camera)/2, y' = 0.5·z_camera - y_camera, w' = z_camera; z' is z_camera.
const Matrix to_window = {0.375f, 0.5f, 1,  1,  //
                          -0.5f,  0,    0,  0,  //
                          0,      -1,   0,  0,  //
                          0.625f, 2.5f, -1, -1};
constexpr glm::ivec2 size{8, 4};

// ---- an EXR file, byte by byte (openexr.com, "OpenEXR File Layout")

template <class T>
std::string bytes_of(const T& value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

template <class T>
std::string attribute(const std::string& name, const std::string& type, const T& value) {
  return name + '\0' + type + '\0' + bytes_of(std::int32_t(sizeof value)) + bytes_of(value);
}

const std::string camera_attributes =
    attribute("worldToCamera", "m44f", to_camera) + attribute("worldToNDC", "m44f", to_window);

// One half-float pixel at (3, 2) of a display window of 8 × 4, uncompressed.
std::string exr_with(const std::string& attributes) {
  using Box = std::array<std::int32_t, 4>;
  const std::string channel =
      std::string("Y\0", 2) + bytes_of(std::array<std::int32_t, 4>{1, 0, 1, 1}) + '\0';
  std::string file = bytes_of(std::int32_t(20000630)) + bytes_of(std::int32_t(2));
  file += std::string("channels\0chlist\0", 16) + bytes_of(std::int32_t(channel.size())) + channel;
  file += attribute("compression", "compression", char(0)) +
          attribute("dataWindow", "box2i", Box{3, 2, 3, 2}) +
          attribute("displayWindow", "box2i", Box{0, 0, size.x - 1, size.y - 1}) +
          attribute("lineOrder", "lineOrder", char(0)) + attribute("pixelAspectRatio", "float", 1.0f) +
          attribute("screenWindowCenter", "v2f", std::array<float, 2>{0, 0}) +
          attribute("screenWindowWidth", "float", 1.0f) + attributes + '\0';
  file += bytes_of(std::int64_t(file.size() + 8));  // where the only line begins
  return file + bytes_of(std::int32_t(2)) + bytes_of(std::int32_t(2)) +
         std::string("\0\x3c", 2);  // y, bytes, 1.0
}

std::string by_hand() { return exr_with(camera_attributes); }

// The 16 numbers behind an attribute's name.
Matrix matrix_in(const std::string& file, const std::string& name) {
  const std::string head = name + '\0' + "m44f" + '\0' + bytes_of(std::int32_t(64));
  const std::size_t at = file.find(head);
  Matrix matrix{};
  EXPECT_NE(at, file.npos) << name;
  if (at != file.npos) std::memcpy(matrix.data(), file.data() + at + head.size(), sizeof matrix);
  return matrix;
}

Device device_by_hand() {
  Device device;
  device.name = "eye";
  // 2 px of 8 at depth 1 are half a unit: fx = 8/2, fy = 4/1. The axis is 0.75/2 of 8 pixels behind the left
  // edge, 0.5 of 4 below the upper one, and an edge is half a pixel before the first centre.
  device.intrinsics = {size, 4, 4, 0.375 * 8 - 0.5, 0.5 * 4 - 0.5};
  // Down is -z: x = 2 - y, y = 3 - z, z = x - 1.
  device.device_from_world = {glm::dmat3(0, 0, 1, -1, 0, 0, 0, -1, 0), {2, 3, -1}};
  return device;
}

// ---- tests

TEST(ExrCamera, ReadsAFileByHand) {
  const testing::ScratchFolder folder;
  const Rig rig = read_rig(testing::write_text(folder / "eye.exr", by_hand()));
  testing::expect_same(testing::device_called(rig, "eye"), device_by_hand(), 1e-9);  // all exact in single
  // (3, 1.5, 3.25) is 2 ahead, 0.5 right, 0.25 up: x' = (0.5 + 1.5)/2 of 2 = 1/2, y' = (1 - 0.25) of 2 = 3/8.
  EXPECT_PIXEL(testing::rig_pixel(rig, "eye", {3, 1.5, 3.25}), 0.5 * 8 - 0.5, 0.375 * 4 - 0.5);
}

TEST(ExrCamera, WritesWhatAHandComputes) {
  const testing::ScratchFolder folder;
  Notes notes;
  const Rig rig{{device_by_hand()}, {}};
  write_rig(folder / "eye.exr", rig_texts(rig, folder / "eye.exr", "", 1, notes));
  const std::string file = read_text(folder / "eye.exr", 4096);
  const Matrix camera = matrix_in(file, "worldToCamera"), window = matrix_in(file, "worldToNDC");
  for (int i = 0; i < 16; ++i) {
    EXPECT_FLOAT_EQ(camera[i], to_camera[i]) << i;
    if (i % 4 == 2) continue;  // z' is passed over
    EXPECT_FLOAT_EQ(window[i], to_window[i]) << i;
  }
  EXPECT_THAT(file, HasSubstr(std::string("cameraLabel\0string\0\3\0\0\0eye", 26)));
  const auto edges = std::string("displayWindow\0box2i\0\x10\0\0\0\0\0\0\0\0\0\0\0\7\0\0\0\3\0\0\0", 40);
  EXPECT_THAT(file, HasSubstr(edges));
}

TEST(ExrCamera, SurvivesARoundTrip) {
  const testing::ScratchFolder folder;
  auto random = testing::generator();
  const Rig rig = testing::random_pair(random, "LENSMODEL_PINHOLE", 0);
  Notes notes;
  write_rig(folder / "both", rig_texts(rig, folder / "both", "exr", 1, notes));
  // Single precision: 6e-8 of each number, some of them added up, of a thousand pixels and of metres.
  testing::expect_same(read_rig(folder / "both"), rig, 1e-6);
  EXPECT_THAT(notes, ::testing::ElementsAre(HasSubstr("EXR knows no projectors")));
}

TEST(ExrCamera, LayersKeepTheirCamera) {
  const testing::ScratchFolder folder;
  Device device = device_by_hand();
  write_exr_layers(folder / "a.exr", {{"depth.m"}, {Image<float>(8, 4, 1.5f)}, picture_camera(device)});
  testing::expect_same(read_exr_camera(folder / "a.exr"), device, 1e-9);
  EXPECT_EQ(device_of(read_exr_layers(folder / "a.exr").camera, size, "").name, "eye");
  // No matrix holds a lens: the place stays, and it is no camera when read back.
  device.lens = {"LENSMODEL_OPENCV4", {0.1, 0, 0, 0}};
  write_exr_layers(folder / "b.exr", {{"depth.m"}, {Image<float>(8, 4, 1.5f)}, picture_camera(device)});
  EXPECT_TRUE(read_exr_layers(folder / "b.exr").camera.camera_from_world);
  EXPECT_THAT(testing::input_error([&] { read_rig(folder / "b.exr"); }), HasSubstr("holds no worldToNDC"));
  EXPECT_THAT(testing::input_error([&] { exr_camera_bytes(device); }), HasSubstr("EXR holds no lens"));
}

TEST(ExrCamera, BadFiles) {
  const testing::ScratchFolder folder;
  const auto error_of = [&](const Matrix& camera, const Matrix& window) {
    const auto path = testing::write_text(
        folder / "eye.exr",
        exr_with(attribute("worldToCamera", "m44f", camera) + attribute("worldToNDC", "m44f", window)));
    return testing::input_error([&] { read_rig(path); });
  };
  const auto with = [](Matrix matrix, int i, float value) {
    matrix[i] = value;
    return matrix;
  };
  EXPECT_THAT(error_of(with(to_camera, 3, 0.5f), to_window), HasSubstr("last column"));
  EXPECT_THAT(error_of(with(to_camera, 2, 3), to_window), HasSubstr("expected a rotation"));
  EXPECT_THAT(error_of(with(to_camera, 2, NAN), to_window), HasSubstr("worldToCamera is not finite"));
  // Looking along -z, as OpenGL: x right, y up, z backwards.
  Matrix looking_back = to_camera;
  looking_back[2] = -1, looking_back[14] = 1;
  EXPECT_THAT(error_of(looking_back, to_window), HasSubstr("right-handed"));
  EXPECT_THAT(error_of(to_camera, with(to_window, 4, 0)), HasSubstr("another place"));
  // y up, (0, 0) at the lower left: y' = 0.5·z_camera + y_camera.
  EXPECT_THAT(error_of(to_camera, with(with(to_window, 9, 1), 13, -3.5f)), HasSubstr("runs backwards"));
  // Parallel: w' = 1.
  EXPECT_THAT(error_of(to_camera, with(with(to_window, 3, 0), 15, 1)), HasSubstr("another place"));
  // x' sheared by 0.1·y_camera.
  EXPECT_THAT(error_of(to_camera, with(with(to_window, 8, 0.1f), 12, 0.325f)), HasSubstr("skewed"));
}

TEST(ExrCamera, APictureWithoutOneIsNone) {
  const testing::ScratchFolder folder;
  const auto path = testing::write_text(folder / "plain.exr", exr_with(""));
  EXPECT_THAT(testing::input_error([&] { read_rig(path); }), HasSubstr("holds no worldToCamera"));
}

}  // namespace
}  // namespace laterna
