#include "render/albedo.h"

#include "sim/shapes.h"
#include "tests/testing.h"

namespace laterna {
namespace {

TEST(AlbedoMapValue, BilinearAndRepeatedByHand) {
  Image<float> map(2, 2);
  map.values = {0.0f, 1.0f, 2.0f, 4.0f};                      // the upper row first: t up
  EXPECT_DOUBLE_EQ(albedo_map_value(map, {0.25, 0.75}), 0);   // centre of the upper left texel
  EXPECT_DOUBLE_EQ(albedo_map_value(map, {0.75, 0.25}), 4);   // lower right
  EXPECT_DOUBLE_EQ(albedo_map_value(map, {0.5, 0.5}), 1.75);  // the middle of all four
  EXPECT_DOUBLE_EQ(albedo_map_value(map, {0, 0.75}), 0.5);    // repeated: between the last and the first
  EXPECT_DOUBLE_EQ(albedo_map_value(map, {-0.75, 3.75}), 0);  // a whole turn away
}

TEST(TextureCoordinatesAt, LinearOverATriangle) {
  const Mesh mesh = plane(2, 4);
  for (const std::uint32_t triangle : {0u, 1u}) {
    const glm::dvec2 st = texture_coordinates_at(mesh, triangle, {0.3, -0.8, 0});
    EXPECT_NEAR(st.x, 0.65, 1e-15);
    EXPECT_NEAR(st.y, 0.3, 1e-15);
  }
}

}  // namespace
}  // namespace laterna
