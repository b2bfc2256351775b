#include "sim/self_contained.h"

#include "sim/ply.h"
#include "sim/scene_build.h"
#include "sim/shapes.h"
#include "tests/sim/scene_text.h"

#include <gmock/gmock.h>

#include <filesystem>

namespace laterna {
namespace {

using testing::with_device;

TEST(SelfContained, ASelfContainedCopyCanBeMoved) {
  const testing::ScratchFolder folder;
  std::filesystem::create_directories(folder / "from/sub");
  std::filesystem::create_directories(folder / "to");
  testing::write_text(folder / "from/sub/a.ply", ply_bytes(make_shape({.shape = "sphere", .detail = 3})));
  testing::write_text(folder / "from/c.cameramodel",
                      "{ 'lensmodel': 'LENSMODEL_PINHOLE', 'intrinsics': [500, 510, 320.25, 240.125],\n"
                      "'extrinsics': [0.1, 0.2, 0.3, 1, 2, 3], 'imagersize': [640, 480] }\n");
  const auto path = testing::write_text(folder / "from/scene.toml",
                                        "[[mesh]]\nfile = \"sub/a.ply\"\nunit = \"cm\"\nup = \"y\"\n" +
                                            with_device("cameramodel = \"c.cameramodel\"\n"));
  const Scene original = load_scene(path);
  const SceneSpec spec = read_scene_spec(path);
  const SceneSpec copied = write_self_contained(spec, original, path.parent_path(), folder / "to");
  EXPECT_EQ(read_scene_spec(folder / "to/scene.toml"), copied);
  std::filesystem::remove_all(folder / "from");
  std::filesystem::rename(folder / "to", folder / "moved");
  const Scene moved = load_scene(folder / "moved/scene.toml");
  ASSERT_EQ(moved.objects.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(moved.objects[i].name, original.objects[i].name);
    EXPECT_EQ(moved.objects[i].mesh.positions, original.objects[i].mesh.positions);
    EXPECT_EQ(moved.objects[i].mesh.triangles, original.objects[i].mesh.triangles);
    EXPECT_EQ(moved.objects[i].world_from_object, original.objects[i].world_from_object);
  }
  EXPECT_EQ(moved.cameras.at(0).device.device_from_world.rotation,
            original.cameras.at(0).device.device_from_world.rotation);
  EXPECT_EQ(moved.cameras[0].device.intrinsics.cy, 240.125);
}

}  // namespace
}  // namespace laterna
