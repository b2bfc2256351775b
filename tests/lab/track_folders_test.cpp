#include "apps/lab/track_folders.h"

#include "apps/lab/capture_writer.h"
#include "sim/scene_build.h"
#include "sim/scene_file.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <set>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::input_error;
using testing::ScratchFolder;

SceneSpec scene_with(double projector_x, int projector_width = 128) {
  return with_names(
      parse_scene(fmt::format("[[mesh]]\nshape = \"relief\"\nshape_size = [2, 1.4, 0.3]\n"
                              "[[projector]]\nname = \"lamp\"\nsize = [{}, 80]\nthrow_ratio = 1.2\n"
                              "position = [{}, -0.1, 2]\nlook_at = [0, 0, 0]\n"
                              "[[camera]]\nname = \"eye\"\nsize = [160, 100]\nfov_x_deg = 42\n"
                              "position = [0, 0.1, 2]\nlook_at = [0, 0, 0]\n",
                              projector_width, projector_x),
                  "tracks.toml"));
}

std::filesystem::path captured(const ScratchFolder& scratch, const std::string& name, const SceneSpec& spec) {
  StageTimes times;
  write_capture(spec, build_scene(spec, scratch.path()), scratch.path(), scratch / name, {}, times);
  return scratch / name;
}

TEST(TrackFolders, OnePointPerCameraPixelAndOneStationPerFolder) {
  const ScratchFolder scratch;
  const SceneSpec left = scene_with(-0.5), right = scene_with(0.4);
  const std::vector<std::filesystem::path> folders{captured(scratch, "left", left),
                                                   captured(scratch, "right", right)};
  TrackFolderOptions options;
  options.stride = 4;
  const Tracks tracks = tracks_of_folders(folders, options);
  ASSERT_EQ(tracks.devices.size(), 2u);
  EXPECT_EQ(tracks.devices[0].name, "eye");
  EXPECT_EQ(tracks.devices[1].intrinsics.size, glm::ivec2(128, 80));
  ASSERT_EQ(tracks.station_count(), 3);
  EXPECT_EQ(tracks.station_name(0), "eye at 0");
  EXPECT_EQ(tracks.station_name(2), "lamp at 1");
  EXPECT_TRUE(tracks.has_sigma);
  std::vector<int> seen(3, 0);
  for (const TrackSighting& s : tracks.sightings) {
    ++seen[std::size_t(s.station)];
    if (s.station > 0) continue;
    EXPECT_EQ(std::fmod(s.pixel.x - 2, 4), 0);  // every fourth pixel, from the second
    EXPECT_EQ(s.sigma_px, options.camera_sigma_px);
  }
  EXPECT_EQ(seen[0], tracks.point_count());  // the camera stayed: each of its pixels is one point
  EXPECT_GT(seen[1], 300);                   // of 40·25 pixels, those that the picture lights
  EXPECT_GT(seen[1] + seen[2], tracks.point_count() + 200);  // most are lit from both places

  options.scene_moved = true;
  const Tracks apart = tracks_of_folders(folders, options);
  EXPECT_EQ(apart.station_count(), 2);
  EXPECT_EQ(apart.point_count(), seen[1] + seen[2]);
  EXPECT_EQ(apart.sightings.size(), 2 * std::size_t(apart.point_count()));
}

TEST(TrackFolders, BadInputIsOneSentence) {
  const ScratchFolder scratch;
  TrackFolderOptions options;
  options.stride = 0;
  EXPECT_THAT(input_error([&] { tracks_of_folders({}, options); }),
              HasSubstr("stride: found 0, expected 1 or more"));
  EXPECT_THAT(input_error([&] { tracks_of_folders({scratch / "nothing"}, {}); }), HasSubstr("nothing"));
  const std::vector<std::filesystem::path> folders{captured(scratch, "one", scene_with(-0.5)),
                                                   captured(scratch, "other", scene_with(0.4, 64))};
  EXPECT_THAT(input_error([&] { tracks_of_folders(folders, {}); }),
              HasSubstr("lamp: 128x80 pixels in one folder and 64x80 in another, expected the same"));
}

}  // namespace
}  // namespace laterna
