#include "render/effects/pixel_geometry.h"

#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

namespace laterna {
namespace {

TEST(PixelGeometry, AgreesWithTheWorld) {
  Scene scene = testing::facing_plane();
  scene.objects.push_back(testing::object_of(sphere(0.2, 10), {0.1, 0.1, 0.4}));
  const testing::Lit lit(scene);
  const PixelGeometry geometry(lit.surface, lit.rays, scene);
  const PixelArray<glm::dvec3> normals = normals_world(lit.surface, lit.rays);
  for (std::size_t p = 0; p < lit.size(); ++p) {
    // 1e-14: rounding of metres.
    EXPECT_NEAR(glm::distance(geometry.point(p) + lit.rays.center_world(), lit.points.values[p]), 0, 1e-14);
    EXPECT_EQ(geometry.normal(p), normals.values[p]);
    const glm::dvec3 x = geometry.in_device(scene.cameras[0].device, p);
    EXPECT_NEAR(x.z, lit.surface.depth_m.values[p], 1e-14);
    EXPECT_NEAR(x.x / x.z * 80 + 29.5, double(p % 60), 1e-11);
  }
}

}  // namespace
}  // namespace laterna
