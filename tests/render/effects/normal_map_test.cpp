#include "render/effects/normal_map.h"

#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

namespace laterna {
namespace {

using testing::facing_plane;
using testing::Lit;

std::shared_ptr<const Image<glm::vec3>> constant_map(const glm::vec3& normal) {
  return std::make_shared<const Image<glm::vec3>>(2, 3, 0.5f * normal + 0.5f);
}

TEST(NormalMap, TiltsTheNormalOfAFacingPlane) {
  Scene scene = facing_plane();
  const Lit plain(scene);
  scene.effects.normal_map = true;
  // s grows along x and t along y on the plane.
  for (const glm::vec3& n : {glm::vec3(0.6f, 0, 0.8f), glm::vec3(0, -0.6f, 0.8f), glm::vec3(0, 0, 1)}) {
    scene.objects[0].normal_map = constant_map(n);
    const Lit lit(scene);
    EXPECT_TRUE(testing::same_bits(lit.surface.object, plain.surface.object));  // the silhouette stays
    for (std::size_t p = 0; p < plain.size(); ++p) {
      const glm::dvec3 l = glm::dvec3(0.2, -0.1, 2) - plain.points.values[p];
      EXPECT_NEAR(lit.light().white_lx.values[p],
                  plain.light().white_lx.values[p] * std::max(0.0, glm::dot(glm::dvec3(n), l)) / l.z,
                  1e-4);  // the map's floats, of 450 lx
    }
  }
}

TEST(NormalMap, FollowsTheObjectAndMirroredTextureCoordinates) {
  Object object = testing::object_of(plane(1, 1));
  object.normal_map = constant_map({0.6f, 0, 0.8f});
  object.world_from_object = glm::rotate(glm::dmat4(1.0), 1.5707963267948966, glm::dvec3(0, 0, 1));
  // 1e-6: the map's floats.
  EXPECT_NEAR(glm::distance(mapped_normal(object, 0, {0.1, 0.1, 0}, {0, 0, 1}), {0, 0.6, 0.8}), 0, 1e-6);
  object.world_from_object = glm::dmat4(1.0);
  for (auto& st : object.mesh.texture_coordinates) st.x = -st.x;
  EXPECT_NEAR(glm::distance(mapped_normal(object, 0, {0.1, 0.1, 0}, {0, 0, 1}), {-0.6, 0, 0.8}), 0, 1e-6);
  for (auto& st : object.mesh.texture_coordinates) st = {0.5, 0.5};
  EXPECT_EQ(mapped_normal(object, 0, {0.1, 0.1, 0}, {0, 0, 1}), glm::dvec3(0, 0, 1));
}

}  // namespace
}  // namespace laterna
