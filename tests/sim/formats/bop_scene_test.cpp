#include "sim/formats/bop_scene.h"

#include "sim/formats/rig_file.h"
#include "sim/image_file.h"
#include "sim/text_file.h"
#include "tests/sim/formats/rigs.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

namespace laterna {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// How much is seen of it, by hand: 12 pixels in all, of which 4 lie beyond the left edge.
const char* const info_by_hand = R"({
  "7": [{"bbox_obj": [-2, 0, 5, 1], "bbox_visib": [1, 0, 1, 0], "px_count_all": 12, "px_count_valid": 3,
         "px_count_visib": 2, "visib_fract": 0.16666666666666666}]
})";

// A scene of 4 × 2 pixels by hand: a camera half a turn about x and 1.5 m away, an object two metres before
// it.
const char* const cameras_by_hand = R"({
  "7": {"cam_K": [4.0, 0.0, 1.5, 0.0, 4.0, 0.5, 0.0, 0.0, 1.0],
        "cam_R_w2c": [1, 0, 0, 0, -1, 0, 0, 0, -1], "cam_t_w2c": [0.0, 0.0, 1500.0], "depth_scale": 0.5}
})";
const char* const poses_by_hand = R"({
  "7": [{"obj_id": 3, "cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_m2c": [10.0, 20.0, 2000.0]}]
})";

template <class T>
Image<T> image(std::vector<T> values) {
  Image<T> picture(4, 2);
  picture.values = std::move(values);
  return picture;
}

// Its pictures of 4 × 2 pixels; PNG itself is the codec's.
void write_scene_by_hand(const fs::path& folder) {
  for (const char* kind : {"depth", "mask", "mask_visib"}) fs::create_directories(folder / kind);
  testing::write_text(folder / "scene_camera.json", cameras_by_hand);
  testing::write_text(folder / "scene_gt.json", poses_by_hand);
  testing::write_text(folder / "scene_gt_info.json", info_by_hand);
  write_picture(folder / "depth" / "000007.png", image<std::uint16_t>({0, 3000, 4000, 65535, 1, 2, 3, 4}));
  write_picture(folder / "mask" / "000007_000000.png", image<std::uint8_t>({0, 255, 255, 255, 0, 255, 0, 0}));
  write_picture(folder / "mask_visib" / "000007_000000.png",
                image<std::uint8_t>({0, 255, 255, 0, 0, 0, 0, 0}));
}

TEST(BopScene, ReadsAFolderByHand) {
  const testing::ScratchFolder scratch;
  write_scene_by_hand(scratch.path());
  const std::vector<BopPicture> pictures = read_bop_scene(scratch.path());
  ASSERT_EQ(pictures.size(), 1u);
  const BopPicture& picture = pictures[0];
  EXPECT_EQ(picture.camera.intrinsics.size, glm::ivec2(4, 2));  // by its depth
  // Half millimetres: 3000 are 1.5 m, 65535 are 32.7675 m. Single precision of metres.
  const std::vector<float> depth_m{NAN, 1.5f, 2.0f, 32.7675f, 0.0005f, 0.001f, 0.0015f, 0.002f};
  EXPECT_THAT(picture.depth_m.values, ::testing::Pointwise(::testing::NanSensitiveFloatEq(), depth_m));
  // Pixel (2, 0) is 0.5/4 right of the axis and 0.5/4 above: at 2 m, (0.25, -0.25, 2) before the camera,
  // which half a turn and 1.5 m take to the world.
  const auto x = WorldProjection(picture.camera).unproject({2, 0}, picture.depth_m(2, 0));
  ASSERT_TRUE(x);
  EXPECT_LT(glm::distance(*x, glm::dvec3(0.25, 0.25, -0.5)), 1e-9);  // a few roundings of metres
  ASSERT_EQ(picture.objects.size(), 1u);
  EXPECT_EQ(picture.objects[0].obj_id, 3);
  EXPECT_EQ(picture.objects[0].camera_from_model.translation, glm::dvec3(0.01, 0.02, 2));
  EXPECT_EQ(picture.objects[0].silhouette(3, 0), 255);
  EXPECT_EQ(picture.objects[0].visible(3, 0), 0);
  EXPECT_TRUE(picture.gray.values.empty());
  ASSERT_TRUE(picture.objects[0].whole);
  EXPECT_EQ(picture.objects[0].whole->count, 12);
  EXPECT_EQ(picture.objects[0].whole->low, glm::ivec2(-2, 0));
  EXPECT_EQ(picture.objects[0].whole->high, glm::ivec2(3, 1));
}

TEST(BopScene, WritesTheSameInfoAgain) {
  const testing::ScratchFolder scratch;
  fs::create_directories(scratch / "theirs");
  write_scene_by_hand(scratch / "theirs");
  Notes notes;
  fs::create_directories(scratch / "ours");
  write_bop_scene(scratch / "ours", read_bop_scene(scratch / "theirs"), notes);
  const Tree written = Tree::parse(read_text(scratch / "ours" / "scene_gt_info.json", 4096));
  // The silhouette has four pixels inside, (1..3, 0) and (1, 1), all with a depth; two are seen, (1, 0), (2,
  // 0).
  Tree expected = Tree::parse(info_by_hand)["7"];
  expected[0]["px_count_valid"] = 4;
  EXPECT_EQ(written["0"], expected);
}

TEST(BopScene, IsARigOfTheSizeOfItsPictures) {
  const testing::ScratchFolder scratch;
  write_scene_by_hand(scratch.path());
  const Rig rig = read_rig(scratch.path());
  EXPECT_EQ(testing::device_called(rig, "7").intrinsics.size, glm::ivec2(4, 2));
}

TEST(BopScene, SurvivesARoundTrip) {
  const testing::ScratchFolder scratch;
  auto random = testing::generator();
  BopPicture near, far;
  near.camera = testing::random_device(random, "near", "LENSMODEL_PINHOLE", 0);
  far.camera = testing::random_device(random, "far", "LENSMODEL_PINHOLE", 0);
  near.camera.intrinsics.size = far.camera.intrinsics.size = {4, 2};
  near.depth_m = image<float>({NAN, 1e-6f, 0.12345f, 6.5535f, 1, 2, 3, 4});
  far.depth_m = image<float>({NAN, 1, 2, 3, 4, 5, 6, 60});
  far.gray = image<std::uint8_t>({0, 1, 2, 3, 4, 5, 6, 255});
  far.objects = {{2, far.camera.device_from_world, image<std::uint8_t>({255, 0, 0, 0, 0, 0, 0, 255}),
                  image<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 255})}};
  Notes notes;
  write_bop_scene(scratch.path(), {near, far}, notes);
  EXPECT_TRUE(fs::exists(scratch / "mask_visib" / "000001_000000.png"));
  const std::vector<BopPicture> read = read_bop_scene(scratch.path());
  ASSERT_EQ(read.size(), 2u);
  // 0.1 mm reach 6.5535 m, 1 mm reach 65 m: half a step is lost, and of the nearest all but one step.
  EXPECT_NEAR(read[0].depth_m(2, 0), near.depth_m(2, 0), 0.51e-4);
  EXPECT_NEAR(read[0].depth_m(3, 0), near.depth_m(3, 0), 0.51e-4);
  EXPECT_FLOAT_EQ(read[0].depth_m(1, 0), 1e-4f);
  EXPECT_TRUE(std::isnan(read[0].depth_m(0, 0)));
  EXPECT_NEAR(read[1].depth_m(3, 1), 60, 0.51e-3);
  EXPECT_EQ(read[1].gray.values, far.gray.values);
  ASSERT_EQ(read[1].objects.size(), 1u);
  EXPECT_EQ(read[1].objects[0].silhouette.values, far.objects[0].silhouette.values);
  EXPECT_EQ(read[1].objects[0].visible.values, far.objects[0].visible.values);
  // Metres to millimetres and back.
  EXPECT_LT(glm::distance(read[1].objects[0].camera_from_model.translation,
                          far.camera.device_from_world.translation),
            1e-15);
  EXPECT_EQ(read[1].camera.name, "far");
}

TEST(BopScene, AnObjectThatIsNotSeenHasNoBoxes) {
  const testing::ScratchFolder scratch;
  auto random = testing::generator();
  BopPicture picture;
  picture.camera = testing::random_device(random, "one", "LENSMODEL_PINHOLE", 0);
  picture.camera.intrinsics.size = {4, 2};
  picture.depth_m = image<float>({NAN, 1, 1, 1, 1, 1, 1, 1});
  picture.objects = {{1,
                      {},
                      image<std::uint8_t>({255, 255, 0, 0, 0, 0, 0, 0}),
                      image<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 0})}};
  Notes notes;
  write_bop_scene(scratch.path(), {picture}, notes);
  const Tree info = Tree::parse(read_text(scratch / "scene_gt_info.json", 4096))["0"][0];
  EXPECT_EQ(info["bbox_obj"], Tree({-1, -1, -1, -1}));
  EXPECT_EQ(info["bbox_visib"], Tree({-1, -1, -1, -1}));
  EXPECT_EQ(info["px_count_all"], 2);
  EXPECT_EQ(info["px_count_valid"], 1);
  EXPECT_EQ(info["visib_fract"], 0.0);
  // Without masks nothing is known, and nothing is written.
  picture.objects[0].visible = {};
  fs::create_directories(scratch / "bare");
  write_bop_scene(scratch / "bare", {picture}, notes);
  EXPECT_FALSE(fs::exists(scratch / "bare" / "scene_gt_info.json"));
}

TEST(BopScene, BadFolders) {
  const testing::ScratchFolder scratch;
  write_scene_by_hand(scratch.path());
  const auto error = [&] { return testing::input_error([&] { read_bop_scene(scratch.path()); }); };
  write_picture(scratch / "mask" / "000007_000000.png", Image<std::uint8_t>(3, 2));
  EXPECT_THAT(error(), HasSubstr("000007_000000.png: 3x2 pixels, expected its camera's 4x2"));
  write_scene_by_hand(scratch.path());
  write_picture(scratch / "depth" / "000007.png", Image<std::uint8_t>(4, 2));
  EXPECT_THAT(error(), HasSubstr("000007.png: expected one channel of 16 bits"));
  write_scene_by_hand(scratch.path());
  std::string text = cameras_by_hand;
  text.replace(text.find("0.5}"), 3, "0.0");
  testing::write_text(scratch / "scene_camera.json", text);
  EXPECT_THAT(error(), HasSubstr("7.depth_scale: found 0.0, expected a number above 0"));
  write_scene_by_hand(scratch.path());
  text = info_by_hand;
  text.replace(text.find("[-2,"), 4, "[0.5,");
  testing::write_text(scratch / "scene_gt_info.json", text);
  EXPECT_THAT(error(), HasSubstr("7[0].bbox_obj: found [0.5,0,5,1], expected whole pixels"));
  testing::write_text(scratch / "scene_camera.json", "{\"seven\": {\"cam_K\": []}}");
  EXPECT_THAT(error(), HasSubstr("found \"seven\", expected a picture's number"));
}

}  // namespace
}  // namespace laterna
