#include "sim/formats/laterna_rig.h"

#include "sim/formats/rig_file.h"
#include "sim/scene_file.h"
#include "tests/sim/formats/rigs.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;

TEST(LaternaRig, ReadsAScenesDevices) {
  const Rig rig = read_rig(testing::data_folder() / "scenes" / "relief.toml");
  const Scene scene = load_scene(testing::data_folder() / "scenes" / "relief.toml");
  ASSERT_EQ(rig.cameras.size(), scene.cameras.size());
  testing::expect_same(rig.projectors.at(0), scene.projectors.at(0).device, 0);
}

TEST(LaternaRig, SceneAndEstimateSurviveARoundTrip) {
  auto random = testing::generator();
  const testing::ScratchFolder folder;
  const Rig rig = testing::random_pair(random, "LENSMODEL_OPENCV5", 5);
  for (const char* file : {"scene.toml", "estimate.json"}) {
    Notes notes;
    write_rig(folder / file, rig_texts(rig, folder / file, "", 1, notes));
    testing::expect_same(read_rig(folder / file), rig, 0);
  }
  EXPECT_EQ(load_scene(folder / "scene.toml").objects.size(), 1u);
}

TEST(LaternaRig, RefusedEstimatesAreLeftOut) {
  const Rig rig = parse_laterna_json(
      R"({"projectors": [{"name": "a", "status": "refused"},
          {"name": "b", "estimate": {"size": [4, 2], "fx": 1, "fy": 2, "cx": 3, "cy": 4,
           "lens": {"model": "LENSMODEL_PINHOLE", "parameters": []},
           "device_from_world": [[1, 0, 0, 5], [0, 1, 0, 6], [0, 0, 1, 7]]}}]})",
      "result.json");
  ASSERT_EQ(rig.projectors.size(), 1u);
  EXPECT_EQ(rig.projectors[0].intrinsics.cy, 4);
  EXPECT_EQ(rig.projectors[0].device_from_world.translation, glm::dvec3(5, 6, 7));
}

TEST(RigFile, SaysWhatIsWrong) {
  const testing::ScratchFolder folder;
  EXPECT_THAT(testing::input_error([&] { read_rig(folder / "none.yml"); }), HasSubstr("no such file"));
  const auto empty = testing::write_text(folder / "empty.yml", "");
  EXPECT_THAT(testing::input_error([&] { read_rig(empty); }), HasSubstr("empty.yml: empty"));
  const auto other = testing::write_text(folder / "other.json", "{\"a\": 1}");
  EXPECT_THAT(testing::input_error([&] { read_rig(other); }), HasSubstr("no calibration that is known"));
  EXPECT_THAT(testing::input_error([&] {
                read_rig(other, {"colmapp", 1, {}, {}});
              }),
              HasSubstr("\"colmapp\""));
  EXPECT_THAT(testing::input_error([&] {
                read_rig(testing::data_folder() / "scenes" / "relief.toml", {"", 0.001, {}, {}});
              }),
              HasSubstr("fixes its unit"));
  Notes notes;
  auto random = testing::generator();
  Rig rig = testing::random_pair(random, "LENSMODEL_PINHOLE", 0);
  EXPECT_THAT(testing::input_error([&] { rig_texts(rig, "x.abc", "", 1, notes); }), HasSubstr("--as"));
  rig.projectors[0].name = "camera";
  EXPECT_THAT(testing::input_error([&] { rig_texts(rig, "x.yml", "", 1, notes); }),
              HasSubstr("a second device"));
}

TEST(RigFile, MrcalsFolderSurvivesARoundTripInMillimetres) {
  auto random = testing::generator();
  const testing::ScratchFolder folder;
  const Rig rig = testing::random_pair(random, "LENSMODEL_OPENCV5", 5);
  Notes notes;
  write_rig(folder / "rig", rig_texts(rig, folder / "rig", "mrcal", 0.001, notes));
  testing::expect_same(read_rig(folder / "rig", {"", 0.001, {}, {}}), rig, 1e-14);  // by Rodrigues vectors
}

}  // namespace
}  // namespace laterna
