// A flat wall and a projector whose intrinsics are known, as a person would calibrate it.
#include "tests/command/run_command.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace laterna {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::laterna;
using testing::ScratchFolder;
using testing::write_text;

const std::string wall = R"(
[[mesh]]
shape = "plane"
shape_size = [3, 2, 1]
[[projector]]
name = "left"
size = [320, 200]
throw_ratio = 1.2
position = [0.4, -0.2, 2.1]
look_at = [0, 0, 0]
up = [0, 1, 0]
[[camera]]
size = [400, 250]
fov_x_deg = 42
position = [-0.35, 0.15, 2.0]
look_at = [0, 0, 0]
up = [0.1, 1, 0]
)";

// fx = throw_ratio·width; the file's placement is another one, and nobody's business.
const std::string model =
    "{ 'lensmodel': 'LENSMODEL_PINHOLE', 'intrinsics': [ 384, 384, 159.5, 99.5 ],\n"
    "'extrinsics': [ 0, 0, 0, 5, 5, 5 ], 'imagersize': [ 320, 200 ] }\n";

TEST(KnownIntrinsics, AFlatWallIsEnoughForThePlacement) {
  const ScratchFolder scratch;
  write_text(scratch / "wall.toml", wall);
  write_text(scratch / "left.cameramodel", model);
  ASSERT_EQ(laterna("capture wall.toml -o wall", scratch.path()).exit_code, 0);
  const auto refused = laterna("calibrate wall", scratch.path());
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.out, HasSubstr("a placement with known intrinsics can"));
  const auto placed = laterna("calibrate wall --known left.cameramodel --json -o left.json", scratch.path());
  ASSERT_EQ(placed.exit_code, 0) << placed.err << placed.out;
  EXPECT_EQ(json::parse(placed.out)["projectors"][0]["free_parameters"], 6);
  const auto verified = laterna("verify wall.toml left.json --json", scratch.path());
  const json error = json::parse(verified.out)["projectors"][0]["volume_error_px"];
  // Rounded Gray codes: three times the clustered prediction is beyond chance for a sum of 6 squared
  // parameters.
  EXPECT_LT(error["rms"].get<double>(), 3 * error["predicted_rms"].get<double>());
  // An estimate serves as well as a model, by its projector's name.
  EXPECT_EQ(laterna("calibrate wall --known left=left.json", scratch.path()).exit_code, 0);
  EXPECT_EQ(laterna("roundtrip wall.toml --known-intrinsics --json", scratch.path()).exit_code, 0);
}

TEST(KnownIntrinsics, WrongWordsAreOneSentence) {
  const ScratchFolder scratch;
  write_text(scratch / "wall.toml", wall);
  write_text(scratch / "left.cameramodel", model);
  ASSERT_EQ(laterna("capture wall.toml -o wall", scratch.path()).exit_code, 0);
  const auto error = [&](const std::string& words) {
    const auto result = laterna("calibrate wall " + words, scratch.path());
    EXPECT_EQ(result.exit_code, 2) << words;
    return result.err;
  };
  EXPECT_THAT(error("--known right=left.cameramodel"), HasSubstr("the pictures show no projector \"right\""));
  EXPECT_THAT(error("--known left=left.cameramodel --known left=left.cameramodel"),
              HasSubstr("is the second for \"left\""));
  EXPECT_THAT(error("--known no.json"), HasSubstr("no.json: cannot be opened"));
}

// The header and the sightings of one flat board, 5×4 corners, before a camera and a projector without lenses
// that stand side by side.
std::string one_pose_table() {
  std::string text = "pose,corner,board_x,board_y,board_z,cam_x,cam_y,proj_x,proj_y,valid\n";
  for (int i = 0; i < 20; ++i) {
    const int row = i / 5, column = i % 5;
    const double x = column - 2.0, y = row - 1.5, z = 10 + 0.4 * x + 0.3 * y;  // tilted
    text += fmt::format("0,{},{},{},0,{:.9f},{:.9f},{:.9f},{:.9f},1\n", i,
                        std::hypot(1, 0.4) * x + 0.12 / std::hypot(1, 0.4) * y,
                        std::sqrt(1 + 0.09 - 0.0144 / 1.16) * y, 199.5 + 400 * x / z, 124.5 + 400 * y / z,
                        159.5 + 384 * (x - 2) / z, 99.5 + 384 * (y + 0.5) / z);
  }
  return text;
}

TEST(KnownIntrinsics, OnePoseOfABoardIsEnoughForThePlacement) {
  const ScratchFolder scratch;
  write_text(scratch / "board.csv", one_pose_table());
  write_text(scratch / "projector.cameramodel", model);
  write_text(scratch / "camera.cameramodel",
             "{ 'lensmodel': 'LENSMODEL_PINHOLE', 'intrinsics': [ 400, 400, 199.5, 124.5 ],\n"
             "'extrinsics': [ 0, 0, 0, 0, 0, 0 ], 'imagersize': [ 400, 250 ] }\n");
  const std::string command = "calibrate board.csv --camera-size 400x250 --projector-size 320x200 --json";
  EXPECT_EQ(laterna(command, scratch.path()).exit_code, 3);
  const std::string known = " --known camera=camera.cameramodel --known projector=projector.cameramodel";
  const auto placed = laterna(command + known, scratch.path());
  ASSERT_EQ(placed.exit_code, 0) << placed.err << placed.out;
  const json projector = json::parse(placed.out)["projectors"][0];
  EXPECT_TRUE(projector["known"].get<bool>());
  const double truth[3] = {-2, 0.5, 0};
  for (int i = 0; i < 3; ++i)  // pixels are written to 1e-9 px, some 1e-10 of a board's unit each
    EXPECT_NEAR(projector["device_from_camera"][i][3].get<double>(), truth[i], 1e-6);
  EXPECT_THAT(laterna(command + " --known camera.cameramodel", scratch.path()).err,
              HasSubstr("of which device"));
  EXPECT_THAT(laterna(command + " --compare" + known, scratch.path()).err,
              HasSubstr("expected one of the two"));
  for (const char* option : {"--lens k1", "--one-focal-length", "--fixed-center"}) {
    const auto idle = laterna(command + known + " " + option, scratch.path());
    EXPECT_EQ(idle.exit_code, 2) << option;
    EXPECT_THAT(idle.err, HasSubstr("with --known for every device: no intrinsics are left to solve for"));
  }
}

}  // namespace
}  // namespace laterna
