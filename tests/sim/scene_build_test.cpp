#include "sim/scene_build.h"

#include "sim/image_file.h"
#include "sim/ply.h"
#include "sim/scene_file.h"
#include "sim/shapes.h"
#include "tests/sim/scene_text.h"

#include <gmock/gmock.h>

#include <cmath>

namespace laterna {
namespace {

using ::testing::AllOf;
using testing::device_lines;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using testing::with_device;
using testing::with_mesh;

TEST(SceneBuild, FileToWorldByHand) {
  MeshSpec mesh{.file = "x.ply"};
  const auto moved = [&](const glm::dvec3& p) {
    return glm::dvec3(world_from_file(mesh) * glm::dvec4(p, 1));
  };
  EXPECT_EQ(moved({1, 2, 3}), glm::dvec3(1, 2, 3));
  mesh.up = UpAxis::y;
  EXPECT_EQ(moved({1, 2, 3}), glm::dvec3(1, -3, 2));
  mesh.unit = "mm";
  mesh.scale = 2000;
  EXPECT_NEAR(glm::distance(moved({1, 2, 3}), glm::dvec3(2, -6, 4)), 0, 1e-14);  // rounding
  mesh.translate = {10, 20, 30};
  EXPECT_NEAR(glm::distance(moved({1, 2, 3}), glm::dvec3(12, 14, 34)), 0, 1e-14);
  mesh = {.file = "x.ply", .rotate_deg = {90, 0, 90}};  // x → y; y → z; z → x: x first, z last
  EXPECT_NEAR(glm::distance(moved({1, 0, 0}), glm::dvec3(0, 1, 0)), 0, 1e-15);
  EXPECT_NEAR(glm::distance(moved({0, 1, 0}), glm::dvec3(0, 0, 1)), 0, 1e-15);
  EXPECT_NEAR(glm::distance(moved({0, 0, 1}), glm::dvec3(1, 0, 0)), 0, 1e-15);
  mesh = {.file = "x.ply",
          .unit = "mm",
          .world_from_object = Matrix3x4{{{0, 2, 0, 5}, {1, 0, 0, 6}, {0, 0, 1, 7}}}};
  EXPECT_NEAR(glm::distance(moved({1000, 2000, 3000}), glm::dvec3(9, 7, 10)), 0, 1e-14);
}

TEST(SceneBuild, LoadsMeshesBesideTheScene) {
  const testing::ScratchFolder folder;
  const Mesh plane = make_shape({.shape = "plane", .detail = 2});
  testing::write_text(folder / "scene.ply", ply_bytes(plane));
  const auto path =
      testing::write_text(folder / "scene.toml",
                          "[[mesh]]\nfile = \"scene.ply\"\n[[projector]]\nname = \"left\"\n" + device_lines);
  const Scene scene = load_scene(path);
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].name, "scene");
  EXPECT_EQ(scene.objects[0].mesh.positions, plane.positions);
  EXPECT_EQ(scene.objects[0].world_from_object, glm::dmat4(1.0));
  EXPECT_EQ(scene.projectors.at(0).device.name, "left");
  EXPECT_TRUE(scene.cameras.empty());
}

TEST(SceneBuild, RefusesBadFiles) {
  const testing::ScratchFolder folder;
  const auto load_error = [&](const std::string& text) {
    const auto path = testing::write_text(folder / "scene.toml", text);
    return testing::input_error([&] { load_scene(path); });
  };
  EXPECT_THAT(load_error("[[mesh]]\nfile = \"none.ply\"\n"),
              AllOf(StartsWith((folder / "scene.toml").string()), HasSubstr("[[mesh]] \"none\""),
                    HasSubstr("none.ply")));
  testing::write_text(folder / "broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
  EXPECT_THAT(load_error("[[mesh]]\nfile = \"broken.ply\"\n"), HasSubstr("broken.ply"));
  EXPECT_THAT(load_error("[[mesh]]\nfile = \".\"\n"), HasSubstr("[[mesh]]"));
  EXPECT_THAT(load_error("[[mesh]]\nshape = \"torus\"\n"), HasSubstr("torus"));
  EXPECT_THAT(load_error(with_mesh("albedo_map = \"none.png\"\n")), HasSubstr("none.png"));
  EXPECT_THAT(load_error(with_mesh("translate = [1e9, 0, 0]\n")), HasSubstr("a vertex comes to lie"));
  EXPECT_THAT(load_error(with_device("cameramodel = \"none.cameramodel\"\n")),
              AllOf(HasSubstr("[[camera]] \"camera\""), HasSubstr("none.cameramodel")));
  EXPECT_THAT(testing::input_error([&] { load_scene(folder / "none.toml"); }),
              StartsWith((folder / "none.toml").string() + ": cannot be opened: No such file"));
  EXPECT_THAT(testing::input_error([&] { load_scene(folder.path()); }), HasSubstr("it is a folder"));
}

TEST(SceneBuild, AlbedoMapsAreLinearAndShared) {
  const testing::ScratchFolder folder;
  write_picture(folder / "map.png", Image<std::uint8_t>(4, 2, 188));
  const std::string mapped = with_mesh("albedo_map = \"map.png\"\n");
  const auto path = testing::write_text(folder / "scene.toml",
                                        mapped + mapped + mapped + "albedo_map_encoding = \"linear\"\n");
  const Scene scene = load_scene(path);
  const auto value = [&](int i) { return (*scene.objects.at(i).albedo_map)(3, 1); };
  // ((188/255 + 0.055)/1.055)^2.4 by hand; 1e-6: floats.
  EXPECT_NEAR(value(0), 0.502886, 1e-6);
  EXPECT_NEAR(value(2), 188 / 255.0, 1e-6);
  EXPECT_EQ(scene.objects[0].albedo_map, scene.objects[1].albedo_map);
  write_picture(folder / "map.exr", Image<float>(4, 2, 1.5f));
  const auto bright = testing::write_text(folder / "b.toml", with_mesh("albedo_map = \"map.exr\"\n"));
  EXPECT_THAT(testing::input_error([&] { load_scene(bright); }),
              HasSubstr("a pixel is 1.5, expected 0 to 1"));
}

TEST(SceneBuild, AlbedoMapsNeedTextureCoordinates) {
  const testing::ScratchFolder folder;
  write_picture(folder / "map.png", Image<std::uint8_t>(4, 2, 188));
  Mesh plane = make_shape({.shape = "plane", .size = {1, 1, 1}, .detail = 2});
  plane.texture_coordinates.clear();
  testing::write_text(folder / "a.ply", ply_bytes(plane));
  const auto path =
      testing::write_text(folder / "s.toml", "[[mesh]]\nfile = \"a.ply\"\nalbedo_map = \"map.png\"\n");
  EXPECT_THAT(testing::input_error([&] { load_scene(path); }), HasSubstr("has no texture coordinates"));
}

TEST(SceneBuild, ChecksASpecificationMadeInCode) {
  SceneSpec spec;
  spec.meshes.push_back({.shape = "plane"});
  spec.cameras.push_back({.device = {.size = glm::ivec2(10, 10),
                                     .fx = std::nan(""),
                                     .position = glm::dvec3(1),
                                     .look_at = glm::dvec3(0)},
                          .sensor = {}});
  EXPECT_THAT(testing::input_error([&] { build_scene(spec, {}); }),
              StartsWith("[[camera]] \"camera\": intrinsics"));
}

}  // namespace
}  // namespace laterna
