// Mistakes of pictures, as they happen in life, and what `laterna score` says of the calibrations that are
// made of them: by `laterna calibrate`, and by OpenCV from decoded maps, as an outside user would.
#include "sim/image_file.h"
#include "tests/command/run_command.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace laterna {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::laterna;
using testing::ScratchFolder;
using testing::write_text;

constexpr int width = 200, height = 130;
constexpr double fov_x_deg = 42;

std::string scene_text(const std::string& patterns, bool is_bent) {
  return fmt::format(R"(
[effects]
response = {}
[[mesh]]
shape = "relief"
shape_size = [1.6, 1.0, 0.7]
detail = 60
seed = 7
[[projector]]
name = "left"
size = [160, 100]
throw_ratio = 1.2
lens_shift = [0.0, 0.1]
position = [0.35, -0.1, 2.1]
look_at = [0, 0, 0]
up = [0, 1, 0]
response_exponent = 2.2
[[camera]]
name = "cam"
size = [{}, {}]
fov_x_deg = {}
position = [-0.35, 0.15, 2.0]
look_at = [0, 0, 0]
up = [0.1, 1, 0]
sensor = {{ noise_sigma_dn = 0.7 }}
[patterns]
{}
)",
                     is_bent, width, height, fov_x_deg, patterns);
}

const std::string gray = "kind = \"gray\"", three_steps = "kind = \"phase\"\nsteps = 3";

// What OpenCV makes of the projector's pixels of points in the camera's frame, as its stereo samples save it.
void write_stereo(const fs::path& path, const cv::Mat& camera,
                  const std::vector<std::vector<cv::Point3f>>& points,
                  const std::vector<std::vector<cv::Point2f>>& pixels) {
  cv::Mat k = (cv::Mat_<double>(3, 3) << 240, 0, 79.5, 0, 240, 49.5, 0, 0, 1);
  cv::Mat distortion = cv::Mat::zeros(5, 1, CV_64F), rotation;
  std::vector<cv::Mat> rotations, translations;
  cv::calibrateCamera(points, pixels, {160, 100}, k, distortion, rotations, translations,
                      cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_K1 | cv::CALIB_FIX_K2 | cv::CALIB_FIX_K3 |
                          cv::CALIB_ZERO_TANGENT_DIST,
                      {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-12});
  cv::Rodrigues(rotations[0], rotation);
  cv::FileStorage file(path.string(), cv::FileStorage::WRITE);
  file << "M1" << camera << "D1" << cv::Mat::zeros(5, 1, CV_64F) << "M2" << k << "D2" << distortion << "R"
       << rotation << "T" << translations[0];
}

// A capture, and the two calibrations of it: whose score names whom.
class SpoiltPictures : public ::testing::Test {
 protected:
  void capture(const std::string& patterns, bool is_bent = false) {
    write_text(scratch_ / "scene.toml", scene_text(patterns, is_bent));
    ASSERT_EQ(run("capture scene.toml -o capture").exit_code, 0);
    for (const auto& file : fs::directory_iterator(scratch_ / "capture/cam/left"))
      pictures_.push_back(file.path());
    std::sort(pictures_.begin(), pictures_.end());
  }
  // Picture order[k] stands in the place of picture k.
  void reorder(const std::vector<int>& order) {
    fs::rename(scratch_ / "capture/cam/left", scratch_ / "taken");
    fs::create_directory(scratch_ / "capture/cam/left");
    for (std::size_t k = 0; k < order.size(); ++k)
      fs::copy_file(scratch_ / "taken" / pictures_[order[k]].filename(), pictures_[k]);
  }
  template <class Edit>
  void edit(const Edit& edit) {
    for (const fs::path& path : pictures_) {
      Picture picture = read_picture(path);
      auto& values = std::get<std::vector<std::uint8_t>>(picture.values);
      edit(values);
      write_picture(path, {values.data(), picture.width, picture.height, 1, PixelType::u8, {}});
    }
  }
  // Statuses and first suspects, "" where nobody is named: of Laterna's result, then of OpenCV's, where it
  // gives one.
  std::vector<std::string> said() {
    const bool is_refused = run("calibrate capture -o left.json").exit_code == 3;
    if (!is_refused) {
      EXPECT_EQ(run("convert left.json left.yml --as opencv").exit_code, 0);
    }
    std::vector words{score(is_refused ? "left.json" : "left.yml")};
    if (calibrate_with_opencv()) words.push_back(score("stereo.yml"));
    return words;
  }
  std::size_t count() const { return pictures_.size(); }

 private:
  testing::CommandResult run(const std::string& words) { return laterna(words, scratch_.path()); }

  std::string score(const std::string& result) {
    const auto scored = run("score capture " + result + " --json");
    const json said = json::parse(scored.out, nullptr, false);
    if (said.is_discarded()) return scored.err;
    const auto& suspects = said["suspects"];
    return said["status"].get<std::string>() + " " +
           (suspects.empty() ? "" : suspects[0]["name"].get<std::string>());
  }

  // The known surface in the camera's frame and the decoded pixels; false where there are none.
  bool calibrate_with_opencv() {
    fs::remove_all(scratch_ / "decoded");
    EXPECT_EQ(run("decode capture -o decoded").exit_code, 0);
    const ExrLayers decoded = read_exr_layers(fs::directory_iterator(scratch_ / "decoded")->path());
    const ExrLayers truth = read_exr_layers(scratch_ / "capture/truth/cam_left.exr");
    const auto layer = [](const ExrLayers& layers, const char* name) -> const std::vector<float>& {
      const auto at = std::find(layers.names.begin(), layers.names.end(), name);
      return layers.planes.at(std::size_t(at - layers.names.begin())).values;
    };
    const auto &u = layer(decoded, "projector.u"), &v = layer(decoded, "projector.v"),
               &valid = layer(decoded, "valid"), &depth = layer(truth, "depth.m");
    const double focal = width / 2.0 / std::tan(fov_x_deg / 2 * std::numbers::pi / 180);
    const double cx = (width - 1) / 2.0, cy = (height - 1) / 2.0;
    std::vector<std::vector<cv::Point3f>> points(1);
    std::vector<std::vector<cv::Point2f>> pixels(1);
    for (int i = 0; i < width * height; i += 3) {  // enough of them
      if (valid[i] != 1 || std::isnan(depth[i])) continue;
      const int x = i % width, y = i / width;
      points[0].emplace_back(float(depth[i] * (x - cx) / focal), float(depth[i] * (y - cy) / focal),
                             depth[i]);
      pixels[0].emplace_back(u[i], v[i]);
    }
    if (pixels[0].empty()) return false;
    cv::Mat camera = (cv::Mat_<double>(3, 3) << focal, 0, cx, 0, focal, cy, 0, 0, 1);
    write_stereo(scratch_ / "stereo.yml", camera, points, pixels);
    return true;
  }

  ScratchFolder scratch_;
  std::vector<fs::path> pictures_;
};

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::Not;
using ::testing::StartsWith;

// Not ok, and the suspect in front.
auto blames(const std::string& suspect) { return AllOf(Not(StartsWith("ok")), EndsWith(" " + suspect)); }

TEST_F(SpoiltPictures, RightOnesNameNobody) {
  capture(three_steps);
  EXPECT_THAT(said(), ElementsAre("ok ", "ok "));
}

TEST_F(SpoiltPictures, GammaIsNamedOfThreeSteps) {
  capture(three_steps, true);
  EXPECT_THAT(said(), ElementsAre("weak gamma", "weak gamma"));
}

TEST_F(SpoiltPictures, GammaDoesNoHarmToBlackAndWhite) {
  capture(gray, true);
  EXPECT_THAT(said(), ElementsAre("ok ", "ok "));
}

TEST_F(SpoiltPictures, AFrameIsDroppedAndLaterOnesMoveUp) {
  capture(gray);
  std::vector<int> order(count());
  for (int k = 0; k < int(count()); ++k) order[k] = k < 7 ? k : std::min(k + 1, int(count()) - 1);
  reorder(order);
  EXPECT_THAT(said(), Each(blames("dropped_frame")));  // nothing can be decoded
}

TEST_F(SpoiltPictures, TwoFramesAreExchanged) {
  capture(three_steps);
  std::vector<int> order(count());
  std::iota(order.begin(), order.end(), 0);
  std::swap(order[0], order[1]);
  reorder(order);
  EXPECT_THAT(said(), ElementsAre(blames("dropped_frame"), blames("dropped_frame")));
}

TEST_F(SpoiltPictures, RowsAreShownBeforeColumns) {
  capture(gray);
  std::vector<int> order(count());
  std::iota(order.begin(), order.end(), 0);
  std::rotate(order.begin(), order.begin() + 16, order.end() - 2);  // 8 bits of columns, 7 of rows
  reorder(order);
  EXPECT_THAT(said(), ElementsAre(blames("axes_exchanged"), blames("axes_exchanged")));
}

TEST_F(SpoiltPictures, TheDriverMirrorsThem) {
  capture(gray);
  edit([](std::vector<std::uint8_t>& values) {
    for (int y = 0; y < height; ++y)
      std::reverse(values.begin() + y * width, values.begin() + (y + 1) * width);
  });
  EXPECT_THAT(said(), ElementsAre(blames("y_flipped"), blames("y_flipped")));
}

}  // namespace
}  // namespace laterna
