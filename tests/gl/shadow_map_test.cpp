// Shadow maps beside our exact shadow rays.
#include "tests/gl/shadow_edges.h"
#include "tests/gl/shipped.h"

#include <fmt/format.h>

namespace laterna::gl {
namespace {

using laterna::testing::Traced;

Scene shadow_scene(const std::string& name) {
  Scene scene = shipped_scene(name);
  scene.effects.irradiance = false;
  scene.projectors[0].lookup = Lookup::bilinear;  // of white: no texel has an edge
  return scene;
}

struct Shadowed {
  const Context context;
  const std::string name;
  const Scene scene;
  const Traced traced;
  const Image<std::uint8_t> white{1920, 1080, 255}, ours;

  explicit Shadowed(const std::string& which)
      : name(which),
        scene(shadow_scene(which)),
        traced(scene),
        ours(our_picture(scene, traced, white, plain_saturation(scene))) {}
  Differences compare(const RasterOptions& options) const {
    const RasterPicture theirs = Rasteriser(scene, options).picture(white, plain_saturation(scene));
    const auto near =
        near_shadow_edges(scene, traced.light, glm::dvec2(1920, 1080) / double(options.shadow_map_px));
    Differences found = compare_dn(ours, traced.light, theirs.uvq1, theirs.dn,
                                   edges(scene, traced.rays, traced.surface, traced.light, &near));
    report(fmt::format("{}, shadow map of {}", name, options.shadow_map_px), found, ours, theirs.dn);
    return found;
  }
};

// Acne: where one side of a fold is steeper for the projector than the other's offset allows for, single
// pixels are dark. Seen: 6 of 860,000.
constexpr double acne = 1e-5;

TEST(ShadowMap, DiffersWithinATexelOfAShadowsEdge) {
  const Shadowed house("house");
  double coarser = 1;
  for (const int n : {512, 1024, 2048, 4096}) {
    const Differences found = house.compare({.shadow_map_px = n});
    EXPECT_LE(double(found.unexplained()), acne * double(found.lit));
    EXPECT_LT(found.share(), coarser);
    coarser = found.share();
  }
  EXPECT_LE(coarser, 1e-3);  // what pictures are allowed to differ by without shadows
}

TEST(ShadowMap, ShadesNothingWhereNothingIsInTheWay) {
  const Shadowed relief("relief");
  ASSERT_EQ(relief.traced.count(Unlit::shadow), 0);
  EXPECT_LE(relief.compare({.shadow_map_px = 1024}).share(), acne);
}

TEST(ShadowMap, WithoutAnOffsetFallsOnTheSurfaceItself) {
  const Shadowed relief("relief");
  const Differences found = relief.compare({.shadow_map_px = 1024, .shadow_slope = 0, .shadow_steps = 0});
  EXPECT_NEAR(found.share(), 0.5, 0.05);  // of each texel, what is behind its middle
}

}  // namespace
}  // namespace laterna::gl
