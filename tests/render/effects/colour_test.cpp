#include "render/effects/colour.h"

#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

namespace laterna {
namespace {

using testing::played;

const std::array<glm::dvec3, 3> mixing{{{0.9, 0.2, 0.05}, {0.1, 0.7, 0.15}, {0.02, 0.3, 0.8}}};

// A facing plane under a Bayer camera, without ambient light.
Scene bayer_scene() {
  Scene scene = testing::facing_plane();
  scene.effects.colour = true;
  scene.cameras[0].colour_filter = ColourFilter::bayer_rggb;
  return scene;
}

// The white and the black picture are the last two.
std::span<const float> white_of(const ImageStack<float>& stack) { return stack.picture(stack.count - 2); }

TEST(Colour, TheFourMosaics) {
  const auto letters = [](ColourFilter filter) {
    std::string text;
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 2; ++x) text += "rgb"[channel_at(filter, {4 + x, 6 + y})];
    return text;
  };
  EXPECT_EQ(letters(ColourFilter::bayer_rggb), "rggb");
  EXPECT_EQ(letters(ColourFilter::bayer_bggr), "bggr");
  EXPECT_EQ(letters(ColourFilter::bayer_grbg), "grbg");
  EXPECT_EQ(letters(ColourFilter::bayer_gbrg), "gbrg");
}

TEST(Colour, RedPatternsLightTheRedSitesAlone) {
  Scene scene = bayer_scene();
  scene.pattern_colour = {1, 0, 0};
  const ImageStack<float> red = played(scene);
  scene.effects.colour = false;
  const ImageStack<float> grey = played(scene);
  ASSERT_EQ(red.count, grey.count);
  for (int k = 0; k < red.count; ++k) {
    for (std::size_t p = 0; p < red.picture_size(); ++p) {
      const bool red_site = p % 60 % 2 == 0 && p / 60 % 2 == 0;
      EXPECT_EQ(red.picture(k)[p], red_site ? grey.picture(k)[p] : 0.0f);
    }
  }
}

TEST(Colour, EachPrimaryComesThroughItsColumnOfTheMixing) {
  Scene scene = bayer_scene();
  const ImageStack<float> grey = played(testing::facing_plane());
  scene.mixings = {{0, 0, mixing}};
  for (int primary = 0; primary < 3; ++primary) {
    scene.pattern_colour = glm::dvec3(0);
    scene.pattern_colour[primary] = 0.5;
    const ImageStack<float> picture = played(scene);
    for (std::size_t p = 0; p < picture.picture_size(); ++p) {
      const int channel = channel_at(ColourFilter::bayer_rggb, {int(p % 60), int(p / 60)});
      const double expected = 0.5 * mixing[channel][primary] * white_of(grey)[p];
      EXPECT_NEAR(white_of(picture)[p], expected, 1e-6 * expected);  // single precision
    }
  }
}

TEST(Colour, AMonoCameraSeesTheMeanOfEachColumn) {
  Scene scene = testing::facing_plane();
  scene.effects.colour = true;
  EXPECT_EQ(primaries_seen(scene, 0, 0, {3, 2}), glm::dvec3(1.0 / 3));
  scene.mixings = {{0, 0, mixing}};
  const glm::dvec3 seen = primaries_seen(scene, 0, 0, {3, 2});
  for (int j = 0; j < 3; ++j) EXPECT_DOUBLE_EQ(seen[j], (mixing[0][j] + mixing[1][j] + mixing[2][j]) / 3);
}

TEST(Colour, GreyPatternsLookAsWithoutIt) {
  Scene scene = testing::facing_plane();
  scene.ambient_lx = 7;
  const ImageStack<float> off = played(scene);
  scene.effects.colour = true;
  for (const ColourFilter filter : {ColourFilter::mono, ColourFilter::bayer_grbg}) {
    scene.cameras[0].colour_filter = filter;
    const ImageStack<float> on = played(scene);
    ASSERT_EQ(on.values.size(), off.values.size());
    for (std::size_t i = 0; i < on.values.size(); ++i)
      EXPECT_NEAR(on.values[i], off.values[i], 1e-6f * off.values[i]);  // single precision
  }
}

TEST(Colour, AmbientLightIsWhite) {
  Scene scene = bayer_scene();
  scene.ambient_lx = 10;
  scene.mixings = {{0, 0, mixing}};
  scene.pattern_colour = {0, 1, 0};  // which ambient light does not care about
  const ImageStack<float> picture = played(scene);
  const double white = luminance_cd_per_m2(scene.objects[0].albedo, 0, 10);
  for (std::size_t p = 0; p < picture.picture_size(); ++p) {
    const glm::dvec3 m = mixing[channel_at(ColourFilter::bayer_rggb, {int(p % 60), int(p / 60)})];
    const double expected = white * (m.x + m.y + m.z);
    EXPECT_NEAR(picture.picture(picture.count - 1)[p], expected, 1e-6 * expected);  // single precision
  }
}

TEST(Colour, AColouredSlideIsThreePictures) {
  Scene scene = bayer_scene();
  scene.mixings = {{0, 0, mixing}};
  scene.effects.slide = true;
  const glm::vec3 rgb(1.0f, 0.4f, 0.2f);
  scene.slide = testing::plain_slide({100, 80}, rgb, 0.5f);
  const ImageStack<float> picture = played(scene), grey = played(testing::facing_plane());
  ASSERT_EQ(picture.count, 1);
  for (std::size_t p = 0; p < picture.picture_size(); ++p) {
    const glm::dvec3 m = mixing[channel_at(ColourFilter::bayer_rggb, {int(p % 60), int(p / 60)})];
    const double expected = glm::dot(m, glm::dvec3(rgb)) * white_of(grey)[p];
    EXPECT_NEAR(picture.picture(0)[p], expected, 1e-6 * expected);  // single precision
  }
}

TEST(Colour, EveryPrimarysPicturesHaveThePanelsEffects) {
  Scene scene = bayer_scene();
  scene.effects.slide = scene.effects.response = scene.effects.black_level = scene.effects.veiling_glare =
      true;
  scene.projectors[0].effects.response_exponent = 2;
  scene.projectors[0].effects.black_level = 0.1;
  scene.projectors[0].effects.veiling_glare = 0.2;  // changes no plain picture
  scene.slide = testing::plain_slide({100, 80}, {1.0f, 0.4f, 0.2f}, 0.5f);
  const ImageStack<float> picture = played(scene), grey = played(testing::facing_plane());
  const double light[] = {1, 0.1 + 0.9 * 0.16, 0.1 + 0.9 * 0.04};
  for (std::size_t p = 0; p < picture.picture_size(); ++p) {
    const int channel = channel_at(ColourFilter::bayer_rggb, {int(p % 60), int(p / 60)});
    const double expected = light[channel] * white_of(grey)[p];
    EXPECT_NEAR(picture.picture(0)[p], expected, 2e-6 * expected);  // a sum in single precision
  }
}

TEST(Colour, OffItHandsTheRowsOn) {
  Scene scene = bayer_scene();
  scene.effects.colour = false;
  scene.mixings = {{0, 0, mixing}};
  scene.pattern_colour = {0.2, 0.3, 0.4};
  const ImageStack<float> off = played(scene), plain = played(testing::facing_plane());
  ASSERT_EQ(off.values.size(), plain.values.size());
  EXPECT_TRUE(std::equal(off.values.begin(), off.values.end(), plain.values.begin()));
}

}  // namespace
}  // namespace laterna
