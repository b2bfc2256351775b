#include "sim/capture_folder.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

CaptureManifest small_manifest() {
  CaptureSequence s;
  s.camera = "cam", s.projector = "left", s.camera_size = {4, 3}, s.projector_size = {8, 2}, s.bit_depth = 12;
  s.saturation_cd_per_m2 = 0.1, s.exposure_time_s = 0.25, s.pictures = {"cam/left/00.png", "cam/left/01.png"},
  s.truth = "truth/cam_left.exr";
  return {"scene.toml", 18446744073709551615ull, "matrices.json", {s}};
}

TEST(CaptureFolder, ManifestRoundTrip) {
  const CaptureManifest before = small_manifest();
  const CaptureManifest after = parse_manifest(manifest_json(before), "m");
  EXPECT_EQ(manifest_json(after), manifest_json(before));
  ASSERT_EQ(after.sequences.size(), 1u);
  EXPECT_EQ(after.seed, before.seed);
  EXPECT_EQ(after.sequences[0].projector_size, glm::ivec2(8, 2));
  EXPECT_EQ(after.sequences[0].saturation_cd_per_m2, 0.1);
  EXPECT_EQ(after.sequences[0].exposure_time_s, 0.25);
  EXPECT_THAT(after.sequences[0].pictures, ElementsAre("cam/left/00.png", "cam/left/01.png"));
}

TEST(CaptureFolder, RefusesWhatIsNoManifest) {
  const auto message = [](const std::string& text) {
    return testing::input_error([&] { parse_manifest(text, "x/manifest.json"); });
  };
  EXPECT_THAT(message("{"), HasSubstr("x/manifest.json: not a capture manifest"));
  EXPECT_THAT(message("[]"), HasSubstr("not a capture manifest"));
  EXPECT_THAT(message(R"({"format":"laterna-capture","version":9})"), HasSubstr("version 9"));
  EXPECT_THAT(message(R"({"format":"laterna-capture","version":1})"), HasSubstr("sequences"));
  EXPECT_THAT(message(R"({"format":"laterna-capture","version":1,"sequences":[{"camera":3}]})"),
              HasSubstr("manifest"));
  EXPECT_THAT(testing::input_error([] { read_manifest("/nonexistent"); }), HasSubstr("no such file"));
}

TEST(CaptureFolder, PlainPicturesComeInTheOrderOfTheirNumbers) {
  const testing::ScratchFolder scratch;
  for (const char* name : {"g_10.png", "g_2.PNG", "g_1.png", "notes.txt", "g_010b.png"})
    testing::write_text(scratch / name, "");
  const CaptureSequence s = plain_sequence(scratch.path(), {{}, {1024, 768}});
  EXPECT_THAT(s.pictures, ElementsAre("g_1.png", "g_2.PNG", "g_10.png", "g_010b.png"));
  EXPECT_THAT(testing::input_error([&] {
                plain_sequence(scratch / "none", {{}, {1, 1}});
              }),
              HasSubstr("expected a folder"));
  std::filesystem::create_directory(scratch / "empty");
  EXPECT_THAT(testing::input_error([&] {
                plain_sequence(scratch / "empty", {{}, {1, 1}});
              }),
              HasSubstr("holds no picture"));
}

}  // namespace
}  // namespace laterna
