// Other people's calibrators, unchanged, on the captures of boards that we export.
#include "sim/formats/rig_file.h"
#include "tests/command/run_command.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>

namespace laterna {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::laterna;
using testing::ScratchFolder;

// What a device saw, picture by picture: the board's point and its pixel, as corners.vnl has them.
struct SeenBoard {
  std::vector<cv::Point3f> board;
  std::vector<cv::Point2f> pixels;
};
using Corners = std::map<std::string, SeenBoard>;

Corners corners_of(const fs::path& file, const std::string& device) {
  Corners corners;
  std::istringstream lines(testing::read_text(file));
  std::string legend;
  std::getline(lines, legend);
  std::map<std::string, int> rows;
  for (std::string picture, x, y, level; lines >> picture >> x >> y >> level;) {
    const int k = rows[picture]++;  // row by row of 9 points, 30 mm apart
    if (!picture.starts_with(device) || level == "-") continue;
    const int column = k % 9, row = k / 9;
    corners[picture].board.emplace_back(0.03f * float(column), 0.03f * float(row), 0.0f);
    corners[picture].pixels.emplace_back(std::stof(x), std::stof(y));
  }
  return corners;
}

// OpenCV's calibration from them: whether fx, fy, cx, cy are within four of its own standard deviations of
// the truth, a chance of 1 in 4000 for eight numbers and normal errors.
void expect_opencv_recovers(const fs::path& file, const Device& truth) {
  std::vector<std::vector<cv::Point3f>> board;
  std::vector<std::vector<cv::Point2f>> seen;
  const Corners corners = corners_of(file, truth.name);
  ASSERT_FALSE(corners.empty());
  for (const auto& [picture, of] : corners) {
    board.push_back(of.board);
    seen.push_back(of.pixels);
  }
  const Intrinsics& k = truth.intrinsics;
  cv::Mat camera_matrix = (cv::Mat_<double>(3, 3) << k.fx * 1.02, 0, k.cx, 0, k.fy * 1.02, k.cy, 0, 0, 1);
  cv::Mat distortion, rvecs, tvecs, sigma, pose_sigma, errors;
  cv::calibrateCamera(board, seen, {k.size.x, k.size.y}, camera_matrix, distortion, rvecs, tvecs, sigma,
                      pose_sigma, errors, cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_K3,
                      {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 300, 1e-12});
  const double found[] = {camera_matrix.at<double>(0, 0), camera_matrix.at<double>(1, 1),
                          camera_matrix.at<double>(0, 2), camera_matrix.at<double>(1, 2)};
  const double expected[] = {k.fx, k.fy, k.cx, k.cy};
  for (int i = 0; i < 4; ++i)
    EXPECT_LT(std::abs(found[i] - expected[i]), 4 * sigma.at<double>(i)) << truth.name << " " << i;
}

// mrcal's difference to the truth over the image, after the motion that fits best, against the uncertainty
// that it predicts of its own solve: both as medians over the image.
const char* const compare = R"(
import sys, json, numpy as np, mrcal
truth, solved = (mrcal.cameramodel(f) for f in sys.argv[1:3])
distance = float(sys.argv[3])
difference = mrcal.projection_diff((truth, solved), gridn_width=12, distance=distance,
                                   use_uncertainties=False, focus_radius=1e6)[0]
q = mrcal.sample_imager(12, 8, *solved.imagersize())
x = distance * mrcal.unproject(q, *solved.intrinsics(), normalize=True)
sigma = mrcal.projection_uncertainty(x, model=solved, what='worstdirection-stdev')
print(json.dumps({"difference": float(np.median(difference)), "sigma": float(np.median(sigma))}))
)";

// A printed board before a small rig, without a lens, so that four terms are more than enough.
const char* const board_scene = R"(
[effects]
antialiasing = true
[[mesh]]
board = "chessboard,9x6,30mm"
detail = 1
rotate_deg = [90, 0, 0]
[[projector]]
size = [256, 192]
fx = 412
fy = 414
cx = 126
cy = 100
position = [-0.15, -0.9, -0.1]
look_at = [0, 0, 0]
flux_lm = 300
[[camera]]
size = [640, 400]
fx = 750
fy = 748
cx = 325
cy = 195
position = [0.1, -0.8, 0.05]
look_at = [0, 0, 0]
samples_per_pixel = 9
sensor = { bit_depth = 8, noise_sigma_dn = 1.0 }
[patterns]
kind = "gray_phase"
pitch_px = 16
)";

struct Against {
  double difference_px, sigma_px;
};

Against mrcal_against(const std::string& solved, const std::string& truth, const fs::path& folder) {
  testing::write_text(folder / "compare.py", compare);
  const std::string command =
      fmt::format("cd '{}' && /usr/bin/python3 compare.py {} {} 0.9 > compare.json 2> compare.err",
                  folder.string(), truth, solved);
  EXPECT_EQ(std::system(command.c_str()), 0) << testing::read_text(folder / "compare.err");
  const json result = json::parse(testing::read_text(folder / "compare.json"));
  return {result["difference"], result["sigma"]};
}

TEST(OtherCalibrators, RecoverTheTruthFromOurBoards) {
  const ScratchFolder scratch;
  testing::write_text(scratch / "board.toml", board_scene);
  const auto captured =
      laterna("capture board.toml --board-places 10 -o boards --format pgm", scratch.path());
  ASSERT_EQ(captured.exit_code, 0) << captured.err;
  const auto converted =
      laterna("convert boards corners --as vnl --board chessboard,9x6,30mm", scratch.path());
  ASSERT_EQ(converted.exit_code, 0) << converted.err;
  const Rig truth = read_rig(scratch / "board.toml");
  expect_opencv_recovers(scratch / "corners" / "corners.vnl", truth.cameras.at(0));
  ASSERT_EQ(laterna("convert board.toml truth --as mrcal", scratch.path()).exit_code, 0);
  if (std::system("command -v mrcal-calibrate-cameras > /dev/null") != 0)
    GTEST_SKIP() << "skipped: mrcal-calibrate-cameras is not installed";
  const std::string solve = fmt::format(
      "cd '{}' && mrcal-calibrate-cameras --corners-cache corners.vnl --lensmodel LENSMODEL_OPENCV4 --focal "
      "750,412 "
      "--object-spacing 0.03 --object-width-n 9 --object-height-n 6 --outdir .. 'camera*.png' "
      "'projector*.png' "
      "> ../solve.txt 2>&1",
      (scratch / "corners").string());
  ASSERT_EQ(std::system(solve.c_str()), 0) << testing::read_text(scratch / "solve.txt");
  for (const auto& [solved, device] :
       {std::pair("camera-0.cameramodel", "camera"), std::pair("camera-1.cameramodel", "projector")}) {
    const Against a = mrcal_against(solved, fmt::format("truth/{}.cameramodel", device), scratch.path());
    // Medians over the image: three of its own standard deviations in the worst direction are beyond chance.
    EXPECT_LT(a.difference_px, 3 * a.sigma_px) << device;
    EXPECT_LT(a.sigma_px, 0.5) << device;  // a calibration, and not an excuse: half a pixel
  }
}

}  // namespace
}  // namespace laterna
