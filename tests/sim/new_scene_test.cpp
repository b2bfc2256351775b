#include "sim/new_scene.h"

#include "sim/scene_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

TEST(NewScene, ParsesAndBuildsWithoutAnyFile) {
  const Scene scene = build_scene(parse_scene(new_scene_text(), "new"), "/nowhere");
  EXPECT_EQ(scene.objects.size(), 2u);
  ASSERT_EQ(scene.projectors.size(), 1u);
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.projectors[0].device.intrinsics.size, glm::ivec2(1920, 1080));
  EXPECT_EQ(scene.cameras[0].device.intrinsics.size, glm::ivec2(1280, 800));
}

bool sees(const WorldProjection& device, const glm::dvec3& x, glm::ivec2 size) {
  const glm::dvec3 p = device.project(x);
  return p.x > -0.5 && p.y > -0.5 && p.x < size.x - 0.5 && p.y < size.y - 0.5;
}

TEST(NewScene, ProjectorAndCameraShareMostOfTheWall) {
  const Scene scene = build_scene(parse_scene(new_scene_text(), "new"), "");
  const WorldProjection projector(scene.projectors[0].device), camera(scene.cameras[0].device);
  int lit = 0, seen = 0, both = 0, all = 0;
  for (const glm::dvec3& p : scene.objects[0].mesh.positions) {
    const glm::dvec3 x(scene.objects[0].world_from_object * glm::dvec4(p, 1));
    const bool by_projector = sees(projector, x, {1920, 1080}), by_camera = sees(camera, x, {1280, 800});
    lit += by_projector, seen += by_camera, both += by_projector && by_camera, ++all;
  }
  // A good rig: most of what is lit is seen, and most of the wall is both.
  EXPECT_GT(both, 0.9 * lit);
  EXPECT_GT(both, 0.6 * all);
  RecordProperty("lit_of_1000", lit * 1000 / all);
  RecordProperty("seen_of_1000", seen * 1000 / all);
  RecordProperty("both_of_1000", both * 1000 / all);
}

TEST(NewScene, KeysAreCommented) {
  // What a newcomer may change carries its unit or its meaning.
  const std::string text = new_scene_text();
  for (const char* key :
       {"ambient_lx", "shape_size", "rotate_deg", "throw_ratio", "lens_shift", "position", "fov_x_deg"}) {
    const auto at = text.find(std::string("\n") + key + " = ");
    ASSERT_NE(at, std::string::npos) << key;
    EXPECT_NE(text.substr(at, text.find('\n', at + 1) - at).find(" # "), std::string::npos) << key;
  }
}

}  // namespace
}  // namespace laterna
