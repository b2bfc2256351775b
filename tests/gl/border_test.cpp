// What OpenGL's own border does to the edge of a projected picture.
#include "tests/gl/shipped.h"

namespace laterna::gl {
namespace {

using laterna::testing::device_at;
using laterna::testing::object_of;
using laterna::testing::scene_of;
using laterna::testing::Traced;

// A small white picture on a wall, 30 camera pixels to a texel.
Scene wall(Lookup lookup) {
  Scene scene = scene_of({object_of(plane(6, 6))}, device_at({0, 0, 2}, {0, 0, 0}, {600, 480}, 600),
                         device_at({0.02, 0.01, 2}, {0.02, 0.01, 0}, {16, 12}, 20));
  scene.effects.shadow = scene.effects.irradiance = scene.effects.back_face = false;
  scene.projectors[0].lookup = lookup;
  return scene;
}

// The share of its light that a texel row's outermost texel gives at u: all of it at its centre, none a whole
// texel further out, where the border's own centre would lie.
double faded(double u, int size) { return std::clamp(std::min(u + 1, size - u), 0.0, 1.0); }

struct Extent {
  double outside = 0, inside = 0;  ///< texels beyond the edge that get light; within it that lack some
};
Extent extent_of(const RasterPicture& picture, glm::ivec2 size) {
  Extent extent;
  for (std::size_t p = 0; p < picture.share.values.size(); ++p) {
    const glm::dvec2 uv(picture.uvq1.values[p]);
    const glm::dvec2 within =
        glm::min(uv + 0.5, glm::dvec2(size) - 0.5 - uv);  // texels, from the nearer edge
    const double depth = std::min(within.x, within.y), share = picture.share.values[p];
    if (depth < 0 && share > 1e-3) extent.outside = std::max(extent.outside, -depth);
    if (depth > 0 && share < 1 - 1e-3) extent.inside = std::max(extent.inside, depth);
  }
  return extent;
}

TEST(HardwareBorder, BlendsHalfATexelEachSide) {
  const Context context;
  const Scene scene = wall(Lookup::bilinear);
  const Image<float> white(16, 12, 1);
  const RasterPicture soft =
      Rasteriser(scene, {.hardware_border = true}).picture(white, plain_saturation(scene));
  for (std::size_t p = 0; p < soft.share.values.size(); ++p) {
    const glm::vec4& uvq1 = soft.uvq1.values[p];
    // Of places, float rounding of T·x: 1e-5 texel of 16.
    EXPECT_NEAR(soft.share.values[p], faded(uvq1.x, 16) * faded(uvq1.y, 12), 1e-4);
  }
  // A camera pixel is 1/30 texel wide, so that the last one seen is up to that much short of the end.
  const Extent extent = extent_of(soft, {16, 12});
  std::cout << "hardware border: light up to " << extent.outside << " texel outside, faded from "
            << extent.inside << " inside\n";
  EXPECT_NEAR(extent.outside, 0.5, 1.0 / 30);
  EXPECT_NEAR(extent.inside, 0.5, 1.0 / 30);
}

TEST(HardwareBorder, IsHardForTheNearestTexel) {
  const Context context;
  const Scene scene = wall(Lookup::nearest);
  const Image<float> white(16, 12, 1);
  const Extent extent = extent_of(
      Rasteriser(scene, {.hardware_border = true}).picture(white, plain_saturation(scene)), {16, 12});
  EXPECT_EQ(extent.outside, 0);
  EXPECT_EQ(extent.inside, 0);
}

TEST(DiscardedBorder, IsHardAndOurs) {
  const Context context;
  const Scene scene = wall(Lookup::bilinear);
  const Traced traced(scene);
  const Image<std::uint8_t> white(16, 12, 255);
  const auto ours = our_picture(scene, traced, white, plain_saturation(scene));
  const RasterPicture theirs = Rasteriser(scene).picture(white, plain_saturation(scene));
  EXPECT_EQ(std::ranges::count(theirs.dn.values, 0) + std::ranges::count(theirs.dn.values, 255), 600 * 480);
  const Differences found = compare_dn(ours, traced.light, theirs.uvq1, theirs.dn,
                                       edges(scene, traced.rays, traced.surface, traced.light));
  EXPECT_EQ(found.unexplained(), 0u);
  EXPECT_EQ(found.greatest, 0);
  report("border", found, ours, theirs.dn);
}

}  // namespace
}  // namespace laterna::gl
