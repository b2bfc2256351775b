// Boards end to end: places drawn, captured, found in the pictures, calibrated, compared with the truth.
#include "apps/lab/board_folders.h"

#include "apps/lab/board_pictures.h"
#include "apps/lab/board_places.h"
#include "apps/lab/capture_writer.h"
#include "calib/boards/calibrate_boards.h"
#include "sim/scene_build.h"
#include "sim/scene_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <numeric>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::input_error;
using testing::ScratchFolder;

SceneSpec scene_with(const std::string& board, const char* patterns = "kind = \"gray_phase\"\nsteps = 4\n") {
  return with_names(
      parse_scene("ambient_lx = 150\n[effects]\nantialiasing = true\n[[mesh]]\nboard = \"" + board +
                      "\"\ndetail = 1\nrotate_deg = [90, 0, 0]\n"
                      "[[projector]]\nsize = [512, 384]\nfx = 820\ncx = 250\ncy = 430\n"
                      "lens = { model = \"LENSMODEL_OPENCV4\", parameters = [-0.05, 0, 0, 0] }\n"
                      "position = [-0.15, -0.9, -0.1]\nlook_at = [0, 0, -0.15]\n"
                      "[[camera]]\nsize = [640, 400]\nfx = 750\n"
                      "lens = { model = \"LENSMODEL_OPENCV4\", parameters = [-0.12, 0, 0, 0] }\n"
                      "position = [0.1, -0.8, 0.05]\nlook_at = [0, 0, 0]\nsamples_per_pixel = 4\n"
                      "[patterns]\n" +
                      std::string(patterns),
                  "boards.toml"));
}

// The rig and the places of the board as they are.
BoardRig true_rig(const Scene& scene, const std::vector<SceneSpec>& places) {
  const Rigid camera_from_world = scene.cameras[0].device.device_from_world;
  const auto parameters = [](const Device& d) {
    std::vector<double> all{d.intrinsics.fx, d.intrinsics.fy, d.intrinsics.cx, d.intrinsics.cy};
    all.insert(all.end(), d.lens.parameters.begin(), d.lens.parameters.end());
    return all;
  };
  BoardRig rig;
  rig.devices = {{parameters(scene.cameras[0].device), {}},
                 {parameters(scene.projectors[0].device),
                  compose(scene.projectors[0].device.device_from_world, inverse(camera_from_world))}};
  for (const SceneSpec& place : places) {
    const glm::dvec3 last = board_points(parse_board(place.meshes.front().board)).back();
    const glm::dmat4 m = world_from_file(place.meshes.front());
    // The board's y points down, the object's up, from the middle.
    const Rigid object_from_board{glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1), {-last.x / 2, last.y / 2, 0}};
    const Rigid world_from_object{glm::dmat3(m), glm::dvec3(m[3])};
    rig.camera_from_board.push_back(
        compose(camera_from_world, compose(world_from_object, object_from_board)));
  }
  return rig;
}

// Over the panel at 0.65 to 1.05 m before the projector: where the estimate puts points fixed on the boards,
// against where they are lit from, rms.
double volume_error_px(const Scene& scene, const std::vector<SceneSpec>& places,
                       const BoardCalibration& calibration) {
  const RigFit& fit = calibration.ladder.fit;
  Device truth = scene.projectors[0].device;
  truth.device_from_world = {};
  const WorldProjection eye(truth);
  std::vector<int> poses(places.size());
  std::iota(poses.begin(), poses.end(), 0);
  double sum = 0;
  int points = 0;
  for (int k = 0; k < 16 * 12 * 3; ++k) {
    const glm::dvec2 pixel(16 + 32 * (k % 16), 16 + 32 * (k / 16 % 12));
    const int layer = k / 192;
    const auto x = eye.unproject(pixel, 0.65 + 0.2 * layer);
    const auto carried = carried_pixel(LensGradient(fit.model.devices[1].lens_model), true_rig(scene, places),
                                       fit.adjustment.rig, poses, 1, x.value());
    const glm::dvec2 d = carried.value() - pixel;
    sum += glm::dot(d, d), ++points;
  }
  return std::sqrt(sum / points);
}

// What a device truly sees of a board's point: the board's middle is the object's origin, y up.
glm::dvec2 true_pixel(const SceneSpec& place, const Device& device, const glm::dvec3& x_board) {
  const PrintedBoard board = parse_board(place.meshes.front().board);
  const glm::dvec3 last = board_points(board).back();
  const glm::dvec4 x_object(x_board.x - last.x / 2, last.y / 2 - x_board.y, 0, 1);
  return glm::dvec2(
      WorldProjection(device).project(glm::dvec3(world_from_file(place.meshes.front()) * x_object)));
}

// Mean and rms of a device's sightings against the truth.
std::pair<glm::dvec2, double> sighting_errors(const BoardFolders& found, const std::vector<SceneSpec>& places,
                                              const Device& truth, int device) {
  glm::dvec2 sum(0.0);
  double squares = 0;
  int count = 0;
  for (const Sighting& s : found.capture.sightings) {
    if (s.device != device) continue;
    const glm::dvec2 d = s.pixel - true_pixel(places[std::size_t(s.pose)], truth, s.x_board);
    sum += d, squares += glm::dot(d, d), ++count;
  }
  return {sum / double(std::max(count, 1)), std::sqrt(squares / std::max(count, 1))};
}

}  // namespace

// Every board is one pose for both cameras; each reads the projector at its own corners. Places within five
// sigmas, which take no account of what corners have in common: twice what noise alone would make likely.
TEST(BoardFolders, TwoCamerasAreCalibratedJointly) {
  const ScratchFolder folder;
  SceneSpec spec = scene_with("chessboard,8x5,32mm", "kind = \"gray\"\n");
  spec.cameras.push_back(spec.cameras.front());
  spec.cameras.back().device.name = "right";
  spec.cameras.back().device.position->x += 0.25;
  StageTimes times;
  write_board_captures(spec, ".", folder / "boards", 4, {.seed = testing::seed(), .truth = false}, times);
  const BoardFolders found =
      read_board_folders({folder / "boards"}, {.boards = {parse_board("chessboard,8x5,32mm")}});
  ASSERT_EQ(found.capture.devices.size(), 3u);
  EXPECT_TRUE(is_camera(found.capture, 0) && is_camera(found.capture, 1) && !is_camera(found.capture, 2));
  EXPECT_EQ(found.placements.size(), 8u) << ::testing::PrintToString(found.warnings);
  EXPECT_EQ(found.capture.pose_count(), 4);
  const Scene scene = build_scene(spec, ".");
  const auto places = board_places(spec, ".", {.count = 4}, testing::seed());
  for (int d = 0; d < 3; ++d) {
    const BoardDevice& device = found.capture.devices[std::size_t(d)];
    const Device* truth = &scene.projectors[0].device;
    for (const Camera& camera : scene.cameras)
      if (camera.device.name == device.name) truth = &camera.device;
    EXPECT_LT(sighting_errors(found, places, *truth, d).second, 0.25) << device.name;  // px; Gray codes alone
  }
  BoardOptions options;
  options.terms.assign(3, {"k1"});
  const BoardCalibration calibration = calibrate_boards(found.capture, options);
  ASSERT_NE(calibration.status, Status::refused) << calibration.reason;
  const Device& first = scene.cameras[found.capture.devices[0].name == "right" ? 1 : 0].device;
  const Device& second = scene.cameras[found.capture.devices[0].name == "right" ? 0 : 1].device;
  const Rigid second_from_first = compose(second.device_from_world, inverse(first.device_from_world));
  const RigColumns columns = columns_of(calibration.ladder.fit.model);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(calibration.devices[1].device_from_world.translation[i], second_from_first.translation[i],
                5 * calibration.sigma[std::size_t(columns.devices[1].pose + 3 + i)]);
}

// The prediction is of the projector's own volume, some of it farther from the boards than this grid; three
// times it is beyond chance for a sum of some ten squared parameters.
TEST(BoardFolders, SixPlacesCalibrateBothDevices) {
  const ScratchFolder folder;
  const SceneSpec spec = scene_with("chessboard,8x5,32mm");
  StageTimes times;
  write_board_captures(spec, ".", folder / "boards", 6, {.seed = testing::seed(), .truth = false}, times);
  const BoardFolders found =
      read_board_folders({folder / "boards"}, {.boards = {parse_board("chessboard,8x5,32mm")}});
  EXPECT_EQ(found.placements.size(), 6u) << ::testing::PrintToString(found.warnings);
  const Scene scene = build_scene(spec, ".");
  const auto places = board_places(spec, ".", {.count = 6}, testing::seed());
  // Four samples a pixel place an edge to about 0.1 px; a tenth of that over a hundred points or more.
  const auto [camera_mean, camera_rms] = sighting_errors(found, places, scene.cameras[0].device, 0);
  const auto [projector_mean, projector_rms] = sighting_errors(found, places, scene.projectors[0].device, 1);
  EXPECT_LT(camera_rms, 0.15);
  EXPECT_LT(glm::length(camera_mean), 0.03);
  EXPECT_LT(projector_rms, 0.15);
  EXPECT_LT(glm::length(projector_mean), 0.04);
  const BoardCalibration calibration = calibrate_boards(found.capture);
  ASSERT_NE(calibration.status, Status::refused) << calibration.reason;
  const double predicted = std::max(calibration.diagnosis.predicted_volume_rms_px,
                                    calibration.diagnosis.jackknife_volume_rms_px.value_or(0));
  EXPECT_LT(volume_error_px(scene, places, calibration), 3 * predicted);
  EXPECT_LT(calibration.fit_rms_px(), 0.15);  // corners to a tenth of a camera pixel, of 1.1 projector pixels
  for (const BoardPlacement& p : found.placements) {
    ASSERT_EQ(p.projectors.size(), 1u);
    EXPECT_GE(p.projectors[0].reading.points,
              16u);  // 60 % of 40 are lit, and an edge of the light takes a row
    EXPECT_LT(p.projectors[0].reading.median_residual_px, 0.3);
  }
  write_board_pictures(folder / "pictures", found, calibration);
  EXPECT_TRUE(std::filesystem::exists(folder / "pictures" / "residuals_projector.png"));
  EXPECT_TRUE(std::filesystem::exists(folder / "pictures" / "found_05.png"));
}

// Two boards in one picture, one of them ChArUco: two poses a folder.
TEST(BoardFolders, TwoBoardsInOnePicture) {
  const ScratchFolder folder;
  SceneSpec spec = scene_with("charuco,6x4,30mm,22mm");
  spec.meshes.front().translate = {-0.13, 0, 0.05};
  spec.meshes.push_back(spec.meshes.front());
  spec.meshes.back().name = "second", spec.meshes.back().board = "chessboard,6x3,22mm";
  spec.meshes.back().translate = {0.13, 0, 0.05};
  StageTimes times;
  write_capture(spec, build_scene(spec, "."), ".", folder / "both", {.truth = false}, times);
  const BoardFolders found = read_board_folders(
      {folder / "both"},
      {.boards = {parse_board("charuco,6x4,30mm,22mm"), parse_board("chessboard,6x3,22mm")}});
  ASSERT_EQ(found.placements.size(), 2u);
  EXPECT_EQ(found.placements[0].points, 15u);
  EXPECT_EQ(found.placements[1].points, 18u);
  EXPECT_EQ(found.capture.pose_count(), 2);
  EXPECT_NE(calibrate_boards(found.capture).status, Status::ok);  // two poses: nothing can be held out
}

TEST(BoardFolders, NoBoardIsARefusalAndSaidSo) {
  const ScratchFolder folder;
  const SceneSpec spec = scene_with("chessboard,8x5,32mm", "kind = \"gray\"\n");
  StageTimes times;
  write_capture(spec, build_scene(spec, "."), ".", folder / "one", {.truth = false}, times);
  const BoardFolders found =
      read_board_folders({folder / "one"}, {.boards = {parse_board("chessboard,9x7,20mm")}});
  EXPECT_TRUE(found.placements.empty());
  ASSERT_FALSE(found.warnings.empty());
  EXPECT_THAT(found.warnings.back(), HasSubstr("no board was found"));
  const BoardCalibration calibration = calibrate_boards(found.capture);
  EXPECT_EQ(calibration.status, Status::refused);
  EXPECT_FALSE(calibration.reason.empty());
}

TEST(BoardFolders, BadInput) {
  const ScratchFolder folder;
  const BoardFolderOptions options{.boards = {parse_board("chessboard,8x5,32mm")}};
  EXPECT_THAT(input_error([&] { read_board_folders({folder / "none"}, options); }),
              HasSubstr("no such folder"));
  EXPECT_THAT(input_error([&] { read_board_folders({folder.path()}, options); }),
              HasSubstr("neither pictures nor folders"));
  const SceneSpec spec = scene_with("chessboard,8x5,32mm", "kind = \"chessboard\"\nsquare_px = 32\n");
  StageTimes times;
  write_capture(spec, build_scene(spec, "."), ".", folder / "one", {.truth = false}, times);
  EXPECT_THAT(input_error([&] { read_board_folders({folder / "one"}, options); }),
              HasSubstr("single points"));
  BoardFolderOptions other = options;
  other.camera = "left";
  EXPECT_THAT(input_error([&] { read_board_folders({folder / "one"}, other); }),
              HasSubstr("no pictures by a camera \"left\""));
}

TEST(BoardPlaces, SameSeedSamePlacesAndAllAreDifferent) {
  const SceneSpec spec = scene_with("chessboard,8x5,32mm");
  const auto a = board_places(spec, ".", {.count = 3}, 7), b = board_places(spec, ".", {.count = 3}, 7);
  EXPECT_EQ(a, b);
  EXPECT_NE(a[0], a[1]);
  EXPECT_NE(a[0], board_places(spec, ".", {.count = 3}, 8)[0]);
}

TEST(BoardPlaces, BadInput) {
  SceneSpec spec = scene_with("chessboard,8x5,3m");
  EXPECT_THAT(input_error([&] { board_places(spec, ".", {.count = 2}, 1); }),
              HasSubstr("expected a smaller board"));
  spec.meshes.front().board.clear(), spec.meshes.front().shape = "plane";
  EXPECT_THAT(input_error([&] { board_places(spec, ".", {.count = 2}, 1); }),
              HasSubstr("no [[mesh]] with board"));
}

// The real capture: Gray codes alone, 63 corners, local fits at the floor of integer codes or below.
TEST(BoardFolders, RealCapture) {
  const char* captures = std::getenv("LATERNA_CAPTURES");
  if (!captures) GTEST_SKIP() << "LATERNA_CAPTURES is not set";
  BoardFolderOptions options{.boards = {parse_board("chessboard,9x7,75mm")}};
  options.patterns = PatternSequence{{}, {1024, 768}};
  const auto folder = std::filesystem::path(captures) / "graycode-procam-kamino";
  const BoardFolders found = read_board_folders({folder / "capture_0"}, options);
  ASSERT_EQ(found.placements.size(), 1u);
  EXPECT_EQ(found.placements[0].points, 63u);
  EXPECT_EQ(found.placements[0].projectors[0].reading.points, 63u);
  EXPECT_LE(found.placements[0].projectors[0].reading.median_residual_px, 0.38);  // the bound
  const BoardCalibration calibration = calibrate_boards(found.capture);
  EXPECT_EQ(calibration.status, Status::refused);
  EXPECT_THAT(calibration.reason, HasSubstr("one pose of a flat board"));
}

}  // namespace laterna
