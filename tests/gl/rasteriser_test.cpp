// Our core beside a real OpenGL: the same T, mesh and slide.
#include "tests/gl/rasteriser.h"

#include "tests/gl/shipped.h"

namespace laterna::gl {
namespace {

using laterna::testing::Traced;

class Shipped : public ::testing::TestWithParam<const char*> {
 protected:
  const Context context_;
};
INSTANTIATE_TEST_SUITE_P(Scenes, Shipped, ::testing::Values("relief", "house"),
                         [](const auto& each) { return std::string(each.param); });

// Before pictures: the projector's pixel at each camera pixel, in floats. A place has no texel edges.
TEST_P(Shipped, ProjectorPixelsAgree) {
  Scene scene = plain_scene(GetParam());
  scene.projectors[0].lookup = Lookup::bilinear;
  const Traced traced(scene);
  const auto slide = grains({1920, 1080});
  const RasterPicture theirs = Rasteriser(scene).picture(slide, plain_saturation(scene));
  const Differences found =
      compare_uv(traced.light, theirs.uvq1, edges(scene, traced.rays, traced.surface, traced.light));
  EXPECT_GT(found.lit, 500000u);
  EXPECT_EQ(found.unexplained(), 0u);
  EXPECT_LE(found.greatest, uv_tolerance_px);
  // Single precision: T·x has steps of 2⁻²⁴ of some 1000 px, a few of them, and 1/3 px more per DN of slope.
  EXPECT_LE(found.rms, 1e-3);
  EXPECT_LE(found.share(), 1e-3);
  report("uv", found, our_picture(scene, traced, slide, plain_saturation(scene)), theirs.dn);
}

// With the nearest texel there is nothing to round: away from edges every pixel is the same.
TEST_P(Shipped, PicturesOfTheNearestTexelAgree) {
  const Scene scene = plain_scene(GetParam());
  const Traced traced(scene);
  const auto slide = grains({1920, 1080}), ours = our_picture(scene, traced, slide, plain_saturation(scene));
  const RasterPicture theirs = Rasteriser(scene).picture(slide, plain_saturation(scene));
  const Differences found = compare_dn(ours, traced.light, theirs.uvq1, theirs.dn,
                                       edges(scene, traced.rays, traced.surface, traced.light));
  EXPECT_EQ(found.unexplained(), 0u);
  EXPECT_EQ(found.greatest, 0);
  EXPECT_LE(found.share(), 1e-3);
  report("nearest", found, ours, theirs.dn);
}

TEST_P(Shipped, BilinearPicturesAgree) {
  Scene scene = plain_scene(GetParam());
  scene.projectors[0].lookup = Lookup::bilinear;
  const Traced traced(scene);
  const auto slide = grains({1920, 1080}), ours = our_picture(scene, traced, slide, plain_saturation(scene));
  const auto at = edges(scene, traced.rays, traced.surface, traced.light);
  Rasteriser rasteriser(scene);
  const RasterPicture theirs = rasteriser.picture(in_floats(slide), plain_saturation(scene));
  const Differences found = compare_dn(ours, traced.light, theirs.uvq1, theirs.dn, at);
  EXPECT_EQ(found.unexplained(), 0u);
  EXPECT_LE(found.share(), 1e-3);
  report("bilinear", found, ours, theirs.dn);

  // A texture of 8 bits has weights of 8 bits at Mesa, and rounds between its three steps: up to 1.5 DN more.
  const RasterPicture coarse = rasteriser.picture(slide, plain_saturation(scene));
  const Differences steps = compare_dn(ours, traced.light, coarse.uvq1, coarse.dn, at);
  EXPECT_LE(steps.greatest, 2);
  EXPECT_LE(steps.share(), 1e-3);
  report("bilinear, 8-bit weights", steps, ours, coarse.dn);
}

// Irradiance and back faces, from the projector's height above each triangle.
TEST_P(Shipped, LightAgrees) {
  Scene scene = plain_scene(GetParam());
  scene.effects.irradiance = scene.effects.back_face = true;
  scene.projectors[0].lookup = Lookup::bilinear;
  const Traced traced(scene);
  const Image<std::uint8_t> white(1920, 1080, 255);
  const double saturation = automatic_saturation(traced);
  const auto ours = our_picture(scene, traced, white, saturation);
  const RasterPicture theirs = Rasteriser(scene).picture(white, saturation);
  const Differences found = compare_dn(ours, traced.light, theirs.uvq1, theirs.dn,
                                       edges(scene, traced.rays, traced.surface, traced.light));
  EXPECT_EQ(found.unexplained(), 0u);
  EXPECT_LE(found.share(), 1e-3);
  report("light", found, ours, theirs.dn);
}

// What other systems write otherwise (README.md): given as a matrix that comes after T.
class OtherHabits : public ::testing::Test {
 protected:
  RasterPicture drawn(const Image<std::uint8_t>& slide, const glm::dmat4& rows) const {
    return Rasteriser(scene_, {.texture_from_texture = glm::transpose(rows)})
        .picture(slide, plain_saturation(scene_));
  }
  const Context context_;
  Scene scene_ = plain_scene("house");
  const Image<std::uint8_t> slide_ = grains({1920, 1080});
  static constexpr glm::dmat4 ours_{1.0};
};

TEST_F(OtherHabits, AnUnscaledRIsNotSeenInAPicture) {
  const glm::dmat4 clip_r({1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 2, -1}, {0, 0, 0, 1});
  EXPECT_EQ(drawn(slide_, clip_r).dn.values, drawn(slide_, ours_).dn.values);
  const auto lit = [](const RasterPicture& picture) {
    return std::ranges::count_if(picture.uvq1.values, [](const glm::vec4& v) { return v.w > 0; });
  };
  // A depth map sees it: r/q, now from -1 to 1, is always less than the map's depth from 0 to 1.
  const auto without_shadows = lit(drawn(slide_, ours_));
  scene_.effects.shadow = true;
  EXPECT_LT(lit(drawn(slide_, ours_)), without_shadows);
  EXPECT_EQ(lit(drawn(slide_, clip_r)), without_shadows);
}

TEST_F(OtherHabits, RowsAreFlippedAtUploadOrInT) {
  const glm::dmat4 flip({1, 0, 0, 0}, {0, -1, 0, 1}, {0, 0, 1, 0}, {0, 0, 0, 1});
  Image<std::uint8_t> unflipped = slide_;  // upload() flips it once more
  for (int y = 0; y < slide_.height; ++y)
    for (int x = 0; x < slide_.width; ++x) unflipped(x, y) = slide_(x, slide_.height - 1 - y);
  const auto once = drawn(slide_, ours_).dn, in_t = drawn(unflipped, flip).dn, twice = drawn(slide_, flip).dn;
  const auto differing = [&](const Image<std::uint8_t>& other) {
    std::size_t count = 0;
    for (std::size_t p = 0; p < once.values.size(); ++p) count += once.values[p] != other.values[p];
    return double(count) / double(once.values.size());
  };
  EXPECT_LE(differing(in_t), 1e-3);  // texel edges: t′ = q - t rounds otherwise
  EXPECT_GT(differing(twice), 0.5);
}

}  // namespace
}  // namespace laterna::gl
