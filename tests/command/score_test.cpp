// `laterna score` as a person would call it.
#include "sim/formats/point_cloud.h"
#include "tests/command/run_command.h"
#include "tests/command/small_scene.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace laterna {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::laterna;
using testing::ScratchFolder;
using testing::small;
using testing::write_text;

json score_of(const std::string& words, const ScratchFolder& scratch, int exit_code) {
  const auto run = laterna("score " + words + " --json", scratch.path());
  EXPECT_EQ(run.exit_code, exit_code) << run.err << run.out;
  return json::parse(run.out, nullptr, false);
}

TEST(ScoreCommand, KeepsItsContract) {
  const ScratchFolder scratch;
  write_text(scratch / "small.toml", small);
  ASSERT_EQ(laterna("capture small.toml -o capture", scratch.path()).exit_code, 0);
  ASSERT_EQ(laterna("calibrate capture -o left.json", scratch.path()).exit_code, 0);
  for (const char* truth : {"small.toml", "capture"}) {
    const json right = score_of(fmt::format("{} left.json", truth), scratch, 0);
    EXPECT_EQ(right["status"], "ok");
    for (const char* key : {"surface_error_px", "volume_error_px", "surface_error_mm"})
      EXPECT_GT(right[key].get<double>(), 0) << key;
    EXPECT_EQ(right["camera_error_px"], nullptr);  // the camera was given
    EXPECT_EQ(right["suspects"], json::array());
  }
  json wrong = json::parse(testing::read_text(scratch / "left.json"));
  wrong["projectors"][0]["cx"] = wrong["projectors"][0]["cx"].get<double>() + 0.5;
  wrong["projectors"][0]["cy"] = wrong["projectors"][0]["cy"].get<double>() + 0.5;
  write_text(scratch / "wrong.json", wrong.dump());
  const json scored = score_of("small.toml wrong.json", scratch, 4);
  EXPECT_EQ(scored["status"], "weak");
  EXPECT_EQ(scored["suspects"][0]["name"], "half_pixel");
  EXPECT_GT(scored["suspects"][0]["explains"].get<double>(), 0.9);
  const auto words = laterna("score small.toml wrong.json", scratch.path());
  EXPECT_THAT(words.out, HasSubstr("move the principal point by half a pixel"));
}

TEST(ScoreCommand, TellsALensThatWasFitted) {
  const ScratchFolder scratch;
  write_text(scratch / "small.toml", small);
  ASSERT_EQ(laterna("convert small.toml camchain.yaml --as kalibr", scratch.path()).exit_code, 0);
  std::string chain = testing::read_text(scratch / "camchain.yaml");
  const auto put = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(chain.find(from), std::string::npos) << chain;
    chain.replace(chain.find(from), from.size(), to);
  };
  put("distortion_coeffs: []", "distortion_coeffs: [0.01, 0, 0, 0]");
  put("distortion_model: none",
      "distortion_model: equidistant");  // the camera's, which then is not the true one
  put("/left/", "/projector/");
  write_text(scratch / "camchain.yaml", chain);
  const json scored = score_of("small.toml camchain.yaml", scratch, 4);
  EXPECT_LT(scored["volume_error_px"].get<double>(), 1e-9);  // roundings of some 300 px
  EXPECT_GT(scored["camera_error_px"].get<double>(), 1);
  ASSERT_EQ(scored["warnings"].size(), 1u);
  EXPECT_THAT(scored["warnings"][0].get<std::string>(),
              HasSubstr("lens of \"cam\": fisheye fitted by a spline"));
  const auto words = laterna("score small.toml camchain.yaml", scratch.path());
  EXPECT_THAT(words.out, ::testing::StartsWith("note: lens of \"cam\""));
}

TEST(ScoreCommand, MissingAndForeignFilesAreOneSentence) {
  const ScratchFolder scratch;
  write_text(scratch / "small.toml", small);
  write_text(scratch / "empty.json", "{}");
  for (const char* words : {"score nowhere.toml empty.json", "score small.toml nowhere.json",
                            "score small.toml empty.json", "score small.toml empty.json --align up"}) {
    const auto run = laterna(words, scratch.path());
    EXPECT_EQ(run.exit_code, 2) << words;
    EXPECT_EQ(run.out, "");
  }
  write_text(
      scratch / "refused.json",
      R"({"format": "laterna-estimate", "version": 1, "projectors": [{"name": "left", "status": "refused"}]})");
  const auto refused = laterna("score small.toml refused.json --json", scratch.path());
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(json::parse(refused.out)["status"], "refused");
}

TEST(ScoreCommand, AFileWithoutPlacementsIsNoResult) {
  const ScratchFolder scratch;
  std::string scene = small;
  scene.replace(scene.find("left"), 4, "projector");  // ROS's names tell what is one
  write_text(scratch / "small.toml", scene);
  ASSERT_EQ(laterna("convert small.toml ros --as ros", scratch.path()).exit_code, 0);
  const auto run = laterna("score small.toml ros", scratch.path());
  EXPECT_EQ(run.exit_code, 2) << run.out;
  EXPECT_THAT(run.err, HasSubstr("as in a file without placements"));
}

TEST(ScoreCommand, AWrongCameraIsNeverOk) {
  const ScratchFolder scratch;
  write_text(scratch / "small.toml", small);
  const json right = score_of("small.toml small.toml", scratch, 0);
  EXPECT_LT(right["camera_error_px"].get<double>(), 1e-9);  // roundings of some 400 px
  std::string other = small;
  other.replace(other.find("fov_x_deg = 42"), 14, "fov_x_deg = 45");
  write_text(scratch / "other.toml", other);
  const json wrong = score_of("small.toml other.toml", scratch, 4);
  EXPECT_EQ(wrong["status"], "weak");
  EXPECT_GT(wrong["camera_error_px"].get<double>(), 1);
}

TEST(ScoreCommand, UnsoundResultsAreOneSentence) {
  const ScratchFolder scratch;
  write_text(scratch / "small.toml", small);
  const std::string device =
      R"({"name": "left", "size": [320, 200], "fx": 400, "fy": 400, "cx": 160, "cy": 100)";
  const std::string pose = R"(, "device_from_world": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 2]]})";
  const auto with = [](const std::string& devices) {
    return fmt::format("{{\"projectors\": [{}]}}", devices);
  };
  for (const auto& [result, words] :
       {std::pair(std::string(), "empty"), std::pair(with(fmt::format("{}}}", device)), "no placement"),
        std::pair(with(fmt::format(R"({}, "fx": NaN{})", device, pose)), "no JSON"),
        std::pair(with(fmt::format(R"({}, "fx": null{})", device, pose)), "must be number"),
        std::pair(with(fmt::format(R"({}, "size": [0, 200]{})", device, pose)), "unusable size"),
        std::pair(with(fmt::format("{0}{1}, {0}{1}", device, pose)), "second projector")}) {
    write_text(scratch / "result.json", result);
    const auto run = laterna("score small.toml result.json --json", scratch.path());
    EXPECT_EQ(run.exit_code, 2) << result;
    EXPECT_EQ(run.out, "");
    EXPECT_THAT(run.err, HasSubstr(words));
  }
}

TEST(ScoreCommand, ARefusedResultIsExplainedByItsPictures) {
  const ScratchFolder scratch;
  write_text(scratch / "small.toml", small);
  ASSERT_EQ(laterna("capture small.toml -o capture", scratch.path()).exit_code, 0);
  const auto pictures = scratch.path() / "capture/cam/left";
  std::filesystem::rename(pictures / "02.png", pictures / "x.png");  // two stored out of order
  std::filesystem::rename(pictures / "03.png", pictures / "02.png");
  std::filesystem::rename(pictures / "x.png", pictures / "03.png");
  ASSERT_EQ(laterna("calibrate capture -o left.json", scratch.path()).exit_code, 3);
  const json scored = score_of("capture left.json", scratch, 3);
  EXPECT_EQ(scored["status"], "refused");
  EXPECT_EQ(scored["suspects"][0]["name"], "dropped_frame");
}

TEST(ScoreCommand, APictureThatIsMissingIsADroppedFrame) {
  const ScratchFolder scratch;
  write_text(scratch / "small.toml", small);
  ASSERT_EQ(laterna("capture small.toml -o capture", scratch.path()).exit_code, 0);
  ASSERT_EQ(laterna("calibrate capture -o left.json", scratch.path()).exit_code, 0);
  std::filesystem::remove(scratch.path() / "capture/cam/left/07.png");
  const json scored = score_of("capture left.json", scratch, 0);  // the calibration itself is right
  EXPECT_EQ(scored["suspects"][0]["name"], "dropped_frame");
}

TEST(ScoreCommand, ACloudOfPointsKeepsTheContract) {
  const ScratchFolder scratch;
  write_text(scratch / "small.toml", small);
  ASSERT_EQ(laterna("capture small.toml -o capture", scratch.path()).exit_code, 0);
  ASSERT_EQ(laterna("convert capture cloud.ply --decoded", scratch.path()).exit_code, 0);
  for (const char* truth : {"small.toml", "capture"}) {
    const json right = score_of(fmt::format("{} cloud.ply", truth), scratch, 0);
    EXPECT_EQ(right["status"], "ok");
    EXPECT_TRUE(right["volume_error_px"].is_null());
    for (const char* key : {"surface_error_px", "surface_error_mm", "point_error_mm", "median_mm", "p95_mm"})
      EXPECT_GT(right[key].get<double>(), 0) << key;
    EXPECT_TRUE(right["outliers"].is_number_unsigned());
    EXPECT_EQ(right["suspects"], json::array());
  }
  // As a scanner writes it: text, millimetres, colours, no pixels.
  const PointCloud cloud = read_point_cloud(scratch / "cloud.ply");
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nend_header\n",
      cloud.points.size());
  for (const CloudPoint& p : cloud.points)
    text += fmt::format("{} {} {} 7\n", 1000 * p.x_world.x, 1000 * p.x_world.y, 1000 * p.x_world.z);
  write_text(scratch / "scan.ply", text);
  const json scored = score_of("small.toml scan.ply", scratch, 4);
  EXPECT_EQ(scored["status"], "weak");
  EXPECT_TRUE(scored["surface_error_px"].is_null() && scored["point_error_mm"].is_null());
  EXPECT_EQ(scored["outliers"], cloud.points.size());
  EXPECT_EQ(scored["suspects"][0]["name"], "unit_scale");
  EXPECT_THAT(laterna("score small.toml scan.ply", scratch.path()).out, HasSubstr("give lengths in metres"));
  const auto refused = laterna("score small.toml scan.ply --align world", scratch.path());
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("the cloud's points have no pixels"));
  write_text(scratch / "bad.ply", text.substr(0, text.size() / 2));
  const auto bad = laterna("score small.toml bad.ply --json", scratch.path());
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_EQ(bad.out, "");
  ASSERT_EQ(laterna("calibrate capture -o left.json", scratch.path()).exit_code, 0);
  EXPECT_THAT(laterna("score small.toml left.json --frame cam", scratch.path()).err,
              HasSubstr("--frame is for a cloud of points"));
}

}  // namespace
}  // namespace laterna
