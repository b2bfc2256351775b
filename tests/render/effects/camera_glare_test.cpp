#include "render/effects/camera_glare.h"

#include "sim/parallel.h"
#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

#include <numeric>

namespace laterna {
namespace {

using testing::played;

constexpr double glare = 0.1;

double mean_of(std::span<const float> picture) {
  return std::accumulate(picture.begin(), picture.end(), 0.0) / double(picture.size());
}

// A plane that gets the same light everywhere, its left part from a slide that is white there.
Scene half_lit() {
  Scene scene = testing::facing_plane();
  scene.effects.irradiance = false;
  scene.effects.slide = true;
  Slide slide{Image<float>(100, 80, 0.0f), true};
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 50; ++x) slide.light(x, y) = 1;
  scene.slide = std::make_shared<const Slide>(std::move(slide));
  scene.cameras[0].veiling_glare = glare;
  return scene;
}

TEST(CameraGlare, AHalfLitPlaneVeilsItsDarkHalf) {
  Scene scene = half_lit();
  const ImageStack<float> clear = played(scene);
  scene.effects.camera_glare = true;
  const ImageStack<float> veiled = played(scene);
  const auto lit =
      double(std::count_if(clear.values.begin(), clear.values.end(), [](float l) { return l > 0; }));
  const double share = lit / double(clear.values.size());
  ASSERT_GT(share, 0.2);
  ASSERT_LT(share, 0.8);
  const double white = *std::max_element(clear.values.begin(), clear.values.end());
  for (std::size_t p = 0; p < clear.values.size(); ++p) {
    const double expected = white * (glare * share + (clear.values[p] > 0 ? 1 - glare : 0));
    EXPECT_NEAR(veiled.values[p], expected, 1e-6 * white);  // single precision
  }
}

TEST(CameraGlare, EveryPictureKeepsItsSum) {
  Scene scene = testing::facing_plane();
  scene.ambient_lx = 20;
  scene.cameras[0].veiling_glare = glare;
  const ImageStack<float> clear = played(scene);
  scene.effects.camera_glare = true;
  for (const Lookup lookup : {Lookup::nearest, Lookup::bilinear}) {
    scene.projectors[0].lookup = lookup;
    const ImageStack<float> veiled = played(scene);
    ASSERT_EQ(veiled.count, clear.count);
    for (int k = 0; k < clear.count; ++k) {
      const double mean = lookup == Lookup::nearest ? mean_of(clear.picture(k)) : mean_of(veiled.picture(k));
      EXPECT_NEAR(mean_of(veiled.picture(k)), mean, 1e-6 * mean);  // single precision
      if (lookup == Lookup::bilinear) continue;
      for (std::size_t p = 0; p < clear.picture_size(); ++p) {
        const double expected = (1 - glare) * clear.picture(k)[p] + glare * mean;
        EXPECT_NEAR(veiled.picture(k)[p], expected, 2e-6 * expected);  // a sum in single precision
      }
    }
  }
}

TEST(CameraGlare, ComesBeforeTheColourFilter) {
  Scene scene = half_lit();
  Slide slide = *scene.slide;
  slide.primaries = {slide.light, Image<float>(100, 80, 0.0f), Image<float>(100, 80, 0.5f)};
  scene.slide = std::make_shared<const Slide>(slide);
  const ImageStack<float> red = played(scene);  // the red picture as grey
  scene.effects.colour = scene.effects.camera_glare = true;
  scene.cameras[0].colour_filter = ColourFilter::bayer_rggb;
  const ImageStack<float> veiled = played(scene);
  const double white = *std::max_element(red.values.begin(), red.values.end()),
               mean_red = mean_of(red.picture(0));
  for (std::size_t p = 0; p < red.values.size(); ++p) {
    const std::size_t channel = p % 60 % 2 + p / 60 % 2;
    const double expected[] = {(1 - glare) * red.values[p] + glare * mean_red, 0, 128 / 255.0 * white};
    EXPECT_NEAR(veiled.values[p], expected[channel], 1e-6 * white);  // single precision
  }
}

TEST(CameraGlare, FollowsTheTimeline) {
  Scene scene = testing::facing_plane();
  scene.cameras[0].veiling_glare = glare;
  scene.effects.camera_glare = true;
  const ImageStack<float> frames = played(scene);
  scene.effects.timing = true;
  scene.timing = {.exposure_delay_frames = 0.5};
  const ImageStack<float> pictures = played(scene);
  for (std::size_t p = 0; p < frames.picture_size(); ++p) {
    const double expected = 0.5 * (frames.picture(0)[p] + frames.picture(1)[p]);
    EXPECT_NEAR(pictures.picture(0)[p], expected, 2e-6 * expected);  // a sum in single precision
  }
}

TEST(CameraGlare, SameBitsForAnyThreads) {
  Scene scene = testing::facing_plane();
  scene.cameras[0].veiling_glare = glare;
  scene.effects.camera_glare = true;
  set_thread_count(1);
  const ImageStack<float> one = played(scene);
  for (const int threads : {2, 7}) {
    set_thread_count(threads);
    EXPECT_TRUE(std::equal(one.values.begin(), one.values.end(), played(scene).values.begin()));
  }
  set_thread_count(0);
}

TEST(CameraGlare, OffItLeavesNoTrace) {
  Scene scene = testing::facing_plane();
  const ImageStack<float> plain = played(scene);
  scene.cameras[0].veiling_glare = glare;
  const ImageStack<float> off = played(scene);
  EXPECT_TRUE(std::equal(plain.values.begin(), plain.values.end(), off.values.begin()));
}

}  // namespace
}  // namespace laterna
