// Calibrations and captures in other people's formats, as a person would convert them.
#include "sim/formats/bop_scene.h"
#include "sim/formats/rig_file.h"
#include "sim/image_file.h"
#include "tests/command/run_command.h"
#include "tests/command/small_scene.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

namespace laterna {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using testing::laterna;
using testing::ScratchFolder;
using ::testing::StartsWith;

const std::string relief = (testing::data_folder() / "scenes" / "relief.toml").string();

TEST(Convert, ACalibrationGoesThroughEveryFormatAndBack) {
  const ScratchFolder scratch;
  const Rig truth = read_rig(relief);
  const Device &camera = truth.cameras.at(0), &projector = truth.projectors.at(0);
  const glm::dvec3 x_world(0.1, 0.05, -0.02);
  const glm::dvec2 pixel = WorldProjection(projector).project(x_world);
  for (const auto& [to, words] : std::map<std::string, std::string>{{"c.yml", ""},
                                                                    {"c.json", ""},
                                                                    {"c.gltf", ""},
                                                                    {"c.usda", ""},
                                                                    {"c.toml", ""},
                                                                    {"mrcal", " --as mrcal"},
                                                                    {"colmap", " --as colmap"},
                                                                    {"bop.json", " --as bop"}}) {
    SCOPED_TRACE(to);
    const auto result = laterna(fmt::format("convert {} {}{} --json", relief, to, words), scratch.path());
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(json::parse(result.out)["written"], to);
    const Rig read = read_rig(scratch / to);
    ASSERT_EQ(read.projectors.size(), 1u);
    // 1e-9 px: turned round, by quaternions or millimetres, a few roundings of thousands of pixels.
    EXPECT_LT(glm::distance(glm::dvec2(WorldProjection(read.projectors[0]).project(x_world)), pixel), 1e-9);
  }
  const glm::dvec3 x_camera = apply(camera.device_from_world, x_world);
  for (const std::string name : {"scan3d", "procam", "slstudio", "opencv-stereo", "kalibr"}) {
    SCOPED_TRACE(name);
    const std::string to = name + (name == "procam" || name == "slstudio" ? ".xml" : ".yml");
    const auto result = laterna(fmt::format("convert {} {} --as {}", relief, to, name), scratch.path());
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("has no world: places are kept relative to"));
    const Rig read = read_rig(scratch / to);
    EXPECT_LT(glm::distance(glm::dvec2(WorldProjection(read.projectors.at(0)).project(x_camera)), pixel),
              1e-9);
  }
}

TEST(Convert, AnEstimateBringsTheCameraThatItWasSolvedFrom) {
  const ScratchFolder scratch;
  testing::write_text(scratch / "small.toml", testing::small);
  ASSERT_EQ(laterna("roundtrip small.toml -o trip", scratch.path()).exit_code, 0);
  for (const std::string name : {"procam", "scan3d", "slstudio", "opencv-stereo"}) {
    const auto result =
        laterna(fmt::format("convert trip/estimate.json {}.xml --as {}", name, name), scratch.path());
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("camera \"cam\" was given, not solved for"));
    const auto scored = laterna(fmt::format("score small.toml {}.xml", name), scratch.path());
    EXPECT_EQ(scored.exit_code, 0) << scored.out << scored.err;
  }
  const auto alone = laterna("convert trip/estimate.json left.cameramodel", scratch.path());
  EXPECT_EQ(alone.exit_code, 0) << alone.err;  // a file, of the projector
  EXPECT_EQ(read_rig(scratch / "left.cameramodel").cameras.size(), 1u);
}

TEST(Convert, TellsHowFarAFisheyesSplineIsOff) {
  const ScratchFolder scratch;
  testing::write_text(scratch / "camchain.yaml", R"(cam0:
  camera_model: pinhole
  distortion_coeffs: [-0.01, 0.02, -0.03, 0.01]
  distortion_model: equidistant
  intrinsics: [460.0, 460.0, 370.0, 240.0]
  resolution: [752, 480]
)");
  const auto result = laterna("convert camchain.yaml cam0.cameramodel", scratch.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("note: lens of \"cam0\": fisheye fitted by a spline of"));
  EXPECT_THAT(read_rig(scratch / "cam0.cameramodel").cameras.at(0).lens.model,
              StartsWith("LENSMODEL_SPLINED"));
  const auto back = laterna("convert camchain.yaml back.yaml --as kalibr", scratch.path());
  EXPECT_EQ(back.exit_code, 2);
  EXPECT_THAT(back.err, HasSubstr("kalibr holds OpenCV's lenses only"));
  EXPECT_FALSE(fs::exists(scratch / "back.yaml"));
}

TEST(Convert, BadWordsAreOneSentence) {
  const ScratchFolder scratch;
  const auto error = [&](const std::string& words) {
    const auto result = laterna("convert " + words, scratch.path());
    EXPECT_EQ(result.exit_code, 2) << result.out;
    return result.err;
  };
  EXPECT_THAT(error("none.yml a.json"), HasSubstr("none.yml: no such file"));
  EXPECT_THAT(error(relief + " a.abc"), HasSubstr("the ending tells no format"));
  EXPECT_THAT(error(relief + " a.yml --as nothing"), HasSubstr("no format is called \"nothing\""));
  EXPECT_THAT(error(relief + " a.yml --unit 0.001"), HasSubstr("fixes its unit"));
  EXPECT_THAT(error(relief + " rig --as gltf"), HasSubstr("expected a name that ends in .gltf"));
  testing::write_text(scratch / "there.yml", "");
  EXPECT_THAT(error(relief + " there.yml"), HasSubstr("is there already"));
  EXPECT_EQ(testing::listing(scratch.path()), "there.yml ");
}

const char* const small = R"(
[[mesh]]
shape = "plane"
shape_size = [3, 2, 1]
[[projector]]
size = [40, 20]
throw_ratio = 1.2
position = [0.4, -0.2, 2.1]
look_at = [0, 0, 0]
up = [0, 1, 0]
[[camera]]
size = [64, 48]
fov_x_deg = 42
position = [-0.35, 0.15, 2.0]
look_at = [0, 0, 0]
up = [0.1, 1, 0]
)";

std::vector<std::uint8_t> bytes_of(const fs::path& path) {
  return std::get<std::vector<std::uint8_t>>(read_picture(path).values);
}

TEST(Convert, GrayCodesInTheOrderOfOtherTools) {
  const ScratchFolder scratch;
  testing::write_text(scratch / "small.toml", small);
  ASSERT_EQ(laterna("capture small.toml -o capture", scratch.path()).exit_code, 0);
  const fs::path ours = scratch / "capture" / "camera" / "projector";
  // 40×20 pixels: 6 bits of columns, 5 of rows, each twice, white, black: 24 pictures.
  ASSERT_EQ(laterna("convert capture procam --as procam", scratch.path()).exit_code, 0);
  EXPECT_EQ(testing::listing(scratch / "procam"), "capture_0 ");
  for (const int k : {0, 11, 12, 22, 23})
    EXPECT_EQ(bytes_of(scratch / "procam" / "capture_0" / fmt::format("graycode_{:02}.png", k)),
              bytes_of(ours / fmt::format("{:02}.png", k)));
  const auto result = laterna("convert capture scan3d --as scan3d", scratch.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("columns count in pixels of 2"));
  const fs::path set = scratch / "scan3d" / "set_00";
  EXPECT_THAT(testing::read_text(set / "projector_info.txt"), StartsWith("32 32\n"));
  // White and black first; then the five coarsest of the column bits, then all row bits, which begin at
  // picture 12.
  for (const auto& [theirs, here] : std::map<int, int>{{1, 22}, {2, 23}, {3, 0}, {12, 9}, {13, 12}, {22, 21}})
    EXPECT_EQ(bytes_of(set / fmt::format("cam_{:02}.png", theirs)),
              bytes_of(ours / fmt::format("{:02}.png", here)));
  EXPECT_FALSE(fs::exists(set / "cam_23.png"));
  ASSERT_EQ(laterna("convert capture slstudio --as slstudio", scratch.path()).exit_code, 0);
  // White, black, then the bits without their inverses, in what SLStudio's virtual camera looks for.
  for (const auto& [theirs, here] :
       std::map<int, int>{{0, 22}, {1, 23}, {2, 0}, {3, 2}, {7, 10}, {8, 12}, {12, 20}})
    EXPECT_EQ(bytes_of(scratch / "slstudio" / "frameSeq_00" / fmt::format("frameSeq_{:02}.bmp", theirs)),
              bytes_of(ours / fmt::format("{:02}.png", here)));
  EXPECT_FALSE(fs::exists(scratch / "slstudio" / "frameSeq_00" / "frameSeq_13.bmp"));
}

TEST(Convert, ACloudIsATableToCalibrateFrom) {
  const ScratchFolder scratch;
  ASSERT_EQ(laterna("capture " + relief + " -o capture", scratch.path()).exit_code, 0);
  ASSERT_EQ(laterna("convert capture cloud.ply", scratch.path()).exit_code, 0);
  const auto result = laterna("convert cloud.ply points.csv --points 500", scratch.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("500 of"));
  const Rig truth = read_rig(relief);
  const auto size = [](const Device& d) {
    return fmt::format("{}x{}", d.intrinsics.size.x, d.intrinsics.size.y);
  };
  const auto solved =
      laterna(fmt::format("calibrate points.csv --camera-size {} --projector-size {} --lens pinhole "
                          "-o found.json --json",
                          size(truth.cameras.at(0)), size(truth.projectors.at(0))),
              scratch.path());
  ASSERT_TRUE(fs::exists(scratch / "found.json")) << solved.err;
  const Rig found = read_rig(scratch / "found.json");
  // The table's pixels are in single precision: 6e-5 px of a thousand.
  EXPECT_NEAR(found.projectors.at(0).intrinsics.fx, truth.projectors.at(0).intrinsics.fx, 0.01);
  EXPECT_NEAR(found.cameras.at(0).intrinsics.fx, truth.cameras.at(0).intrinsics.fx, 0.01);
  testing::write_text(scratch / "plain.ply",
                      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                      "property float z\nend_header\n1 2 3\n");
  const auto plain = laterna("convert plain.ply plain.csv", scratch.path());
  EXPECT_EQ(plain.exit_code, 2);
  EXPECT_THAT(plain.err, HasSubstr("plain.ply: its points have no pixels to calibrate from"));
}

const Image<float>& layer(const ExrLayers& layers, const std::string& name) {
  const auto found = std::find(layers.names.begin(), layers.names.end(), name);
  EXPECT_NE(found, layers.names.end()) << name;
  return layers.planes.at(std::size_t(found - layers.names.begin()));
}

// A board half a metre before the plane hides a part of it.
const std::string two_meshes = std::string(small) + R"(
[[mesh]]
shape = "plane"
name = "board"
shape_size = [0.3, 0.2, 1]
translate = [0.05, 0.02, 0.5]
)";

TEST(Convert, ATruthMapIsItsCamera) {
  const ScratchFolder scratch;
  testing::write_text(scratch / "small.toml", small);
  ASSERT_EQ(laterna("capture small.toml -o capture", scratch.path()).exit_code, 0);
  const auto result = laterna("convert capture/truth/camera_projector.exr a.json", scratch.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Device read = read_rig(scratch / "a.json").cameras.at(0),
               truth = read_rig(scratch / "small.toml").cameras.at(0);
  EXPECT_EQ(read.name, "camera");
  const glm::dvec3 x_world(0.1, 0.05, 0);
  // The file's numbers are in single precision: 6e-8 of each, and some are added up, of tens of pixels.
  EXPECT_LT(glm::distance(WorldProjection(read).project(x_world), WorldProjection(truth).project(x_world)),
            1e-5);
}

TEST(Convert, ACaptureIsASceneOfBops) {
  const ScratchFolder scratch;
  testing::write_text(scratch / "small.toml", two_meshes);
  ASSERT_EQ(laterna("capture small.toml -o capture", scratch.path()).exit_code, 0);
  const auto result = laterna("convert capture bop --as bop", scratch.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const ExrLayers truth = read_exr_layers(scratch / "capture" / "truth" / "camera_projector.exr");
  const Image<float>&depth_m = layer(truth, "depth.m"), &id = layer(truth, "object.id");
  const std::vector<BopPicture> pictures = read_bop_scene(scratch / "bop");
  ASSERT_EQ(pictures.size(), 1u);
  ASSERT_EQ(pictures[0].objects.size(), 2u);
  const BopObject &plane = pictures[0].objects[0], &board = pictures[0].objects[1];
  std::size_t hidden = 0, seen = 0;
  for (std::size_t i = 0; i < depth_m.values.size(); ++i) {
    const float depth = pictures[0].depth_m.values[i];
    ASSERT_EQ(std::isfinite(depth), std::isfinite(depth_m.values[i]));
    if (std::isfinite(depth)) {
      ASSERT_NEAR(depth, depth_m.values[i], 0.51e-4);  // in steps of 0.1 mm: half of one is lost
    }
    ASSERT_EQ(plane.visible.values[i], id.values[i] == 0 ? 255 : 0);
    ASSERT_EQ(board.visible.values[i], id.values[i] == 1 ? 255 : 0);
    ASSERT_EQ(board.silhouette.values[i], board.visible.values[i]);  // nothing stands before it
    hidden += plane.silhouette.values[i] != plane.visible.values[i];
    seen += board.visible.values[i] != 0;
  }
  EXPECT_GT(seen, 20u);
  EXPECT_EQ(hidden, seen);  // the plane goes on behind the whole board
  // The pose: the board's middle is where the world has it.
  const glm::dvec3 there = apply(pictures[0].camera.device_from_world, {0.05, 0.02, 0.5});
  EXPECT_LT(glm::distance(apply(board.camera_from_model, glm::dvec3(0)), there),
            1e-12);  // millimetres and back
  ASSERT_EQ(laterna("convert bop layers --as exr", scratch.path()).exit_code, 0);
  const ExrLayers layers = read_exr_layers(scratch / "layers" / "camera.exr");
  EXPECT_EQ(layer(layers, "object.id").values, id.values);
  EXPECT_TRUE(layers.camera.window_from_world);
}

TEST(Convert, CloudsOfPointsLieOnTheSurface) {
  const ScratchFolder scratch;
  testing::write_text(scratch / "small.toml", small);
  ASSERT_EQ(laterna("capture small.toml -o capture", scratch.path()).exit_code, 0);
  ASSERT_EQ(laterna("convert capture true.ply", scratch.path()).exit_code, 0);
  ASSERT_EQ(laterna("convert capture decoded.ply --decoded", scratch.path()).exit_code, 0);
  for (const auto& [file, tolerance_m] :
       std::map<std::string, double>{
           {"true.ply", 1e-6},  // single precision of metres
           {"decoded.ply",
            0.15}})  // a projector pixel is 4 cm wide on the plane; the base is a third of the distance
  {
    const std::string ply = testing::read_text(scratch / file);
    const std::size_t body = ply.find("end_header\n") + 11, count = (ply.size() - body) / 40;
    EXPECT_GT(count, 200u) << file;
    for (std::size_t i = 0; i < count; ++i) {
      double z = 0;
      std::memcpy(&z, ply.data() + body + 40 * i + 16, sizeof z);
      ASSERT_LT(std::abs(z), tolerance_m) << file;  // the plane z = 0
    }
  }
}

}  // namespace
}  // namespace laterna
