#include "sim/formats/gltf.h"

#include "sim/formats/rig_file.h"
#include "tests/sim/formats/rigs.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::rig_pixel;

// yfov = 2·atan(0.5): the picture is as high as it is far. The node stands 2 m above the origin and looks
// down its parent's -z, which a quarter turn about x makes the world's -y... by rows (x, y, z) -> (x, -z, y).
const char* const by_hand = R"({"asset": {"version": "2.0"},
 "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9272952180016122, "aspectRatio": 1.25, "znear": 0.1}}],
 "nodes": [{"name": "parent", "rotation": [0.7071067811865476, 0, 0, 0.7071067811865476], "children": [1]},
           {"name": "eye", "camera": 0, "translation": [0, 0, 2]}]})";

TEST(Gltf, ReadsAFileByHand) {
  const testing::ScratchFolder folder;
  const Rig rig = read_rig(testing::write_text(folder / "c.gltf", by_hand), {"", 1, {640, 512}, {0, 0}});
  // The camera stands at the parent's (0, 0, 2), which is the world's (0, -2, 0), and looks along the
  // parent's -z: the world's +y; up is the parent's y: the world's +z. The world's (0.1, -1, 0.2) is 1 m
  // ahead, 0.1 right, 0.2 up. fy = H = 512, fx = W/1.25 = 512; the centre is the middle of the picture.
  EXPECT_PIXEL(rig_pixel(rig, "eye", {0.1, -1, 0.2}), 319.5 + 512 * 0.1, 255.5 - 512 * 0.2);
}

// A node by its matrix, column by column: the camera's right, up and back in the world, then where it stands.
// It looks along the world's +x, up is +z: right is -y. Without aspectRatio pixels are square. Other
// extensions are passed over.
TEST(Gltf, ReadsAMatrixByHand) {
  const Rig rig = parse_gltf(R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9272952180016122, "znear": 0.1, "zfar": 9}}],
    "nodes": [{"name": "proj", "camera": 0, "matrix": [0, -1, 0, 0,  0, 0, 1, 0,  -1, 0, 0, 0,  1, 2, 3, 1]},
              {"name": "lamp", "extensions": {"KHR_lights_punctual": {"light": 0}}}]})",
                             {640, 480}, "c.gltf");
  ASSERT_EQ(rig.projectors.size(), 1u);
  // (2, 1.9, 3.2) is 1 m ahead, 0.1 right, 0.2 up; f = 480/(2·0.5).
  EXPECT_PIXEL(rig_pixel(rig, "proj", {2, 1.9, 3.2}), 319.5 + 480 * 0.1, 239.5 - 480 * 0.2);
}

TEST(Gltf, SurvivesARoundTripByItsBlock) {
  auto random = testing::generator();
  const Rig rig = testing::random_pair(random, "LENSMODEL_OPENCV8", 8);
  Notes notes;
  testing::expect_same(parse_gltf(gltf_text(rig, notes), {0, 0}, "x"), rig,
                       1e-14);  // a motion turned round twice
  EXPECT_EQ(notes.size(), 2u);
}

TEST(Gltf, OtherReadersSeeTheSameFieldOfView) {
  auto random = testing::generator();
  Rig rig;
  rig.cameras = {testing::random_device(random, "eye", "LENSMODEL_PINHOLE", 0)};
  rig.cameras[0].intrinsics.cx = 319.5;
  rig.cameras[0].intrinsics.cy = 239.5;
  Notes notes;
  Tree file = Tree::parse(gltf_text(rig, notes));
  EXPECT_EQ(notes, Notes{});
  file["cameras"][0].erase("extensions");
  testing::expect_same(parse_gltf(file.dump(), {640, 480}, "x"), rig, 1e-14);  // tan(atan) and back
}

TEST(Gltf, BadFiles) {
  const auto error_of = [](const std::string& from, const std::string& to) {
    std::string text = by_hand;
    text.replace(text.find(from), from.size(), to);
    return testing::input_error([&] { parse_gltf(text, {640, 512}, "c.gltf"); });
  };
  EXPECT_THAT(error_of("\"perspective\", ", "\"orthographic\", "), HasSubstr("found \"orthographic\""));
  EXPECT_THAT(error_of("\"children\": [1]", "\"children\": [0]"), HasSubstr("its own parent"));
  EXPECT_THAT(error_of("\"children\": [1]", "\"children\": [1, 1]"), HasSubstr("two parents"));
  EXPECT_THAT(error_of("\"children\": [1]", "\"children\": [9]"), HasSubstr("indices of nodes"));
  EXPECT_THAT(error_of("\"translation\"", "\"scale\": [2, 2, 2], \"t\""), HasSubstr("scale"));
  EXPECT_THAT(error_of("0.927", "7.927"), HasSubstr("radians"));
  EXPECT_THAT(error_of("\"camera\": 0", "\"camera\": 4"), HasSubstr("cameras: holds 1 entries"));
}

}  // namespace
}  // namespace laterna
