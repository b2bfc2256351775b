// Tables of correspondences given to `laterna calibrate`.
#include "tests/command/run_command.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <tuple>

namespace laterna {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::laterna;
using testing::listing;
using testing::ScratchFolder;
using testing::write_text;

struct Place {
  double x, y, z;
};

// A corner of a flat board of 5 × 4 that stands tilted before the first camera, in its frame.
Place corner_in_camera(int pose, double bx, double by) {
  const double about = 1.3 * pose, tilt = 0.5, c = std::cos(tilt), s = std::sin(tilt);
  const double ax = std::cos(about), ay = std::sin(about), x = bx - 0.2, y = by - 0.15;
  const double along = ax * x + ay * y;  // Rodrigues' formula about (ax, ay, 0)
  return {c * x + (1 - c) * along * ax + 0.05 * (pose % 3 - 1),
          c * y + (1 - c) * along * ay + 0.04 * (pose % 2), s * (ax * y - ay * x) + 1.5 + 0.1 * pose};
}

// Noise below 0.05 px, so that there is something to estimate.
double noise_px(int k) { return 0.05 * std::sin(12.9898 * k); }

// A camera at the origin and a projector 0.3 to its left, whose frame is turned by nothing.
std::string board_table(int poses) {
  std::string text = "pose,corner,board_x,board_y,board_z,cam_x,cam_y,proj_x,proj_y,valid\n";
  for (int pose = 0; pose < poses; ++pose) {
    for (int corner = 0; corner < 20; ++corner) {
      const double bx = 0.1 * (corner % 5), by = 0.1 * ((corner - corner % 5) / 5.0);
      const Place p = corner_in_camera(pose, bx, by);
      const double n = noise_px(corner + 20 * pose), m = noise_px(7 * corner + 140 * pose + 3);
      text += fmt::format("{},{},{},{},0,{},{},{},{},1\n", pose, corner, bx, by, 900 * p.x / p.z + 320 + n,
                          900 * p.y / p.z + 240 + m, 800 * (p.x + 0.3) / p.z + 250 - m,
                          800 * p.y / p.z + 380 + n);
    }
  }
  return text;
}

// The same boards before two cameras, 0.2 apart, and the projector; a line for each sighting.
std::string sighting_table(int poses) {
  std::string text = "device,pose,corner,board_x,board_y,board_z,x,y\n";
  for (int pose = 0; pose < poses; ++pose) {
    for (const auto& [device, f, shift, cy] : {std::tuple("left", 900.0, 0.0, 240.0),
                                               {"right", 880.0, -0.2, 240.0},
                                               {"beamer", 800.0, 0.3, 380.0}}) {
      for (int corner = 0; corner < 20; ++corner) {
        const double bx = 0.1 * (corner % 5), by = 0.1 * ((corner - corner % 5) / 5.0);
        const Place p = corner_in_camera(pose, bx, by);
        const int k = corner + 20 * pose + int(f);
        text +=
            fmt::format("{},{},{},{},{},0,{},{}\n", device, pose, corner, bx, by,
                        f * (p.x + shift) / p.z + 310 + noise_px(k), f * p.y / p.z + cy + noise_px(3 * k));
      }
    }
  }
  return text;
}

TEST(Tables, CalibrateTakesATableOfCorrespondences) {
  const ScratchFolder scratch;
  write_text(scratch / "board.csv", board_table(6));
  const std::string words =
      "calibrate board.csv --camera-size 640x480 --projector-size 640x480 --lens pinhole";
  const auto result = laterna(words + " --json -o out.json", scratch.path());
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  const json parsed = json::parse(result.out);
  EXPECT_EQ(parsed.at("status"), "ok");
  EXPECT_EQ(parsed.at("reason"), "");
  EXPECT_LT(parsed.at("fit_rms_px").get<double>(), 0.1);
  EXPECT_LT(parsed.at("held_out_px").at("rms").get<double>(), 0.2);
  EXPECT_EQ(parsed.at("held_out_px").at("folds").size(), 6u);
  for (const char* kind : {"cameras", "projectors"}) {
    const json& device = parsed.at(kind).at(0);
    EXPECT_EQ(device.at("size"), json({640, 480}));
    EXPECT_EQ(device.at("lens").at("model"), "LENSMODEL_PINHOLE");
    EXPECT_TRUE(device.at("lens").at("parameters").is_array());
    EXPECT_GT(device.at("sigma").at("fx").get<double>(), 0);
  }
  EXPECT_NEAR(parsed["cameras"][0]["fx"], 900, 10);  // some five sigma
  EXPECT_NEAR(parsed["projectors"][0]["cy"], 380, 10);
  const json rows = parsed["projectors"][0]["device_from_camera"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_NEAR(rows[0][3], 0.3, 0.02);
  EXPECT_FALSE(parsed.at("ladder").empty());
  EXPECT_EQ(json::parse(testing::read_text(scratch / "out.json")), parsed);
  const auto text = laterna(words + " --compare", scratch.path());
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out,
              ::testing::AllOf(HasSubstr("lens ladder"), HasSubstr("projector translation_x"),
                               HasSubstr("verdict: ok"), HasSubstr("opencv-joint"), HasSubstr("mrcal")));
}

TEST(Tables, TablesThatCannotTellAreRefusedOrWeak) {
  const ScratchFolder scratch;
  write_text(scratch / "one.csv", board_table(1));
  write_text(scratch / "two.csv", board_table(2));
  const std::string sizes = " --camera-size 640x480 --projector-size 640x480 --json";
  const auto one = laterna("calibrate one.csv" + sizes, scratch.path());
  EXPECT_EQ(one.exit_code, 3);
  EXPECT_EQ(json::parse(one.out).at("status"), "refused");
  EXPECT_THAT(json::parse(one.out).at("reason").get<std::string>(), HasSubstr("one pose"));
  const auto two = laterna("calibrate two.csv" + sizes, scratch.path());
  EXPECT_THAT(two.exit_code, ::testing::AnyOf(3, 4));
}

TEST(Tables, BadTablesAndWordsAreOneSentence) {
  const ScratchFolder scratch;
  write_text(scratch / "board.csv", board_table(3));
  write_text(scratch / "rig.csv", sighting_table(3));
  write_text(scratch / "bad.csv", board_table(3) + "0,99,1,2\n");
  std::filesystem::create_directory(scratch / "folder");
  const std::string sizes = " --camera-size 640x480 --projector-size 640x480";
  for (const auto& [words, expected] : std::vector<std::pair<std::string, std::string>>{
           {"bad.csv" + sizes, "bad.csv: line 62: found 4 cells, expected 10"},
           {"none.csv" + sizes, "none.csv"},
           {"board.csv --projector-size 640x480", "--camera-size is missing"},
           {"board.csv --camera-size 640x480", "--projector-size is missing"},
           {"board.csv --camera-size 640x480" + sizes, "--camera-size stands 2 times"},
           {"rig.csv" + sizes, "--camera-size: found \"640x480\", expected NAME=WIDTHxHEIGHT"},
           {"rig.csv --projector-size beamer=640x480", "--camera-size is missing"},
           {"rig.csv --camera-size left=640x480", "line 22: device is \"right\", expected one of left"},
           {"board.csv --camera-size 100x100 --projector-size 640x480",
            "expected one in an image of 100x100"},
           {"board.csv --lens fisheye" + sizes, "lens is \"fisheye\", expected auto"},
           {"board.csv --scene s.toml" + sizes, "--scene is for pictures"},
           {"folder --lens k1", "--lens is for boards"},
           {"folder --camera-size 3x4 --board chessboard,9x7,75mm", "--camera-size is for a table"},
           {"board.csv --board chessboard,9x7,75mm" + sizes, "--board is for pictures"},
           {"folder --board chess", "board \"chess\", expected chessboard"},
           {"folder folder", "2 folders, expected one"}}) {
    const auto result = laterna("calibrate " + words, scratch.path());
    EXPECT_EQ(result.exit_code, 2) << words;
    EXPECT_THAT(result.err, HasSubstr(expected)) << words;
    EXPECT_EQ(result.out, "") << words;
  }
}

TEST(Tables, ATableOfManyDevicesIsCalibratedJointly) {
  const ScratchFolder scratch;
  write_text(scratch / "rig.csv", sighting_table(6));
  const auto result = laterna(
      "calibrate rig.csv --camera-size left=640x480 --camera-size right=640x480 --projector-size "
      "beamer=640x480 --lens pinhole --json",
      scratch.path());
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  const json parsed = json::parse(result.out);
  ASSERT_EQ(parsed.at("cameras").size(), 2u);
  ASSERT_EQ(parsed.at("projectors").size(), 1u);
  EXPECT_EQ(parsed["cameras"][1]["name"], "right");
  EXPECT_NEAR(parsed["cameras"][1]["fx"], 880, 10);  // some five sigma
  EXPECT_NEAR(parsed["cameras"][1]["device_from_camera"][0][3], -0.2, 0.02);
  EXPECT_NEAR(parsed["projectors"][0]["device_from_camera"][0][3], 0.3, 0.02);
}

// What one calibration found of the camera is a prior of the next, with its sigmas.
TEST(Tables, AnEarlierEstimateIsAPrior) {
  const ScratchFolder scratch;
  write_text(scratch / "board.csv", board_table(6));
  write_text(scratch / "few.csv", board_table(3));
  const std::string sizes = " --camera-size 640x480 --projector-size 640x480 --lens pinhole ";
  ASSERT_EQ(laterna("calibrate board.csv -o before.json" + sizes, scratch.path()).exit_code, 0);
  const json before = json::parse(testing::read_text(scratch / "before.json"));
  const auto text = laterna("calibrate few.csv --known camera=before.json" + sizes, scratch.path());
  EXPECT_THAT(text.out, HasSubstr("known intrinsics are a prior, with their sigmas")) << text.err;
  const auto result = laterna("calibrate few.csv --json --known camera=before.json" + sizes, scratch.path());
  const auto alone = laterna("calibrate few.csv --json" + sizes, scratch.path());
  const auto sigma = [](const json& estimate) {
    return estimate.at("cameras").at(0).at("sigma").at("fx").get<double>();
  };
  EXPECT_LE(sigma(json::parse(result.out)), sigma(before));
  EXPECT_LT(sigma(json::parse(result.out)), sigma(json::parse(alone.out)));
}

TEST(Tables, ASplinedLensNamesItsGrid) {
  const ScratchFolder scratch;
  write_text(scratch / "board.csv", board_table(6));
  const auto result = laterna(
      "calibrate board.csv --camera-size 640x480 --projector-size 640x480 --lens splined,pinhole --json",
      scratch.path());
  // Twenty corners a pose do not tell a spline's every knot: weak, and never without saying so.
  ASSERT_EQ(result.exit_code, 4) << result.err << result.out;
  EXPECT_THAT(json::parse(result.out).at("reason").get<std::string>(), HasSubstr("its spline is predicted"));
  const json camera = json::parse(result.out).at("cameras").at(0);
  EXPECT_THAT(camera.at("lens").at("model").get<std::string>(),
              HasSubstr("LENSMODEL_SPLINED_STEREOGRAPHIC_order=3"));
  EXPECT_FALSE(camera.at("sigma").contains("fx"));  // held
}

// A calibration's JSON becomes a page and figures beside it, or neither.
TEST(Tables, ReportLeavesAPageAndItsFigures) {
  const ScratchFolder scratch;
  write_text(scratch / "board.csv", board_table(6));
  laterna("calibrate board.csv --camera-size 640x480 --projector-size 640x480 -o board.json", scratch.path());
  std::filesystem::create_directory(scratch / "there");
  const auto refused = laterna("report board.json --figures there", scratch.path());
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("there"));
  EXPECT_EQ(listing(scratch.path()), "board.csv board.json there ");
  const auto page = laterna("report board.json --figures figures", scratch.path());
  EXPECT_EQ(page.exit_code, 0) << page.err;
  EXPECT_THAT(page.out, HasSubstr("open board.html"));
  EXPECT_THAT(listing(scratch / "figures"), HasSubstr("lens_ladder.svg"));
  EXPECT_THAT(testing::read_text(scratch / "board.html"), HasSubstr("<!doctype html>"));
  EXPECT_EQ(laterna("report nowhere", scratch.path()).exit_code, 2);
}

}  // namespace
}  // namespace laterna
