// Each picture of a short sequence, predicted by hand.
#include "render/effects/timing.h"

#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

constexpr int patterns = 5;

// "0, 1/4 1 + 3/4 2, ..." as numbers: shares[picture][frame].
std::vector<std::vector<double>> shares_of(const Timeline& timeline, int row = 0, int source = 0,
                                           int frames = patterns) {
  std::vector<std::vector<double>> shares;
  for (const PictureFrames& picture : timeline.frames_of_row(row, source)) {
    shares.emplace_back(frames, 0.0);
    for (const FrameShare& f : picture) shares.back().at(f.frame) += double(f.share);
  }
  return shares;
}

std::vector<std::vector<double>> shares_of(const Timing& timing, int row = 0, int source = 0) {
  return shares_of(make_timeline(timing, patterns, 3, false), row, source);
}

void expect_shares(const std::vector<std::vector<double>>& found,
                   const std::vector<std::vector<double>>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k)
    for (std::size_t f = 0; f < found[k].size(); ++f)
      EXPECT_NEAR(found[k][f], expected[k][f], 1e-6) << k << " " << f;  // single precision
}

// Where each picture is one frame.
std::vector<std::vector<double>> whole(const std::vector<int>& frames) {
  std::vector<std::vector<double>> shares;
  for (const int frame : frames) shares.emplace_back(patterns, 0.0).at(frame) = 1;
  return shares;
}

TEST(Timing, ADroppedFrameBringsTheNextPatternsEarlier) {
  expect_shares(shares_of({.dropped_frame = 2}), whole({0, 1, 3, 4, 4}));
}

TEST(Timing, ARepeatedFrameDelaysThePatternsAfterIt) {
  expect_shares(shares_of({.repeated_frame = 2}), whole({0, 1, 1, 2, 3}));
  expect_shares(shares_of({.repeated_frame = 0}), whole({0, 0, 1, 2, 3}));
}

TEST(Timing, ADropAndARepeatCancelFromThereOn) {
  expect_shares(shares_of({.dropped_frame = 1, .repeated_frame = 3}), whole({0, 2, 3, 3, 4}));
}

TEST(Timing, ALateExposureMixesTwoPatterns) {
  expect_shares(shares_of({.exposure_delay_frames = 0.25}), {{0.75, 0.25, 0, 0, 0},
                                                             {0, 0.75, 0.25, 0, 0},
                                                             {0, 0, 0.75, 0.25, 0},
                                                             {0, 0, 0, 0.75, 0.25},
                                                             {0, 0, 0, 0, 1}});
  expect_shares(shares_of({.exposure_delay_frames = -1}), whole({0, 0, 1, 2, 3}));
}

TEST(Timing, ARollingShutterMixesMoreAndMoreOfTheNextPattern) {
  const Timing rolling{.rolling_shutter_frames = 0.5};
  expect_shares(shares_of(rolling, 0), whole({0, 1, 2, 3, 4}));
  expect_shares({shares_of(rolling, 1)[1]}, {{0, 0.75, 0.25, 0, 0}});
  expect_shares({shares_of(rolling, 2)[1]}, {{0, 0.5, 0.5, 0, 0}});
}

TEST(Timing, ALongExposureMeetsTheNextPatternUnlessEachIsShownLonger) {
  expect_shares({shares_of({.exposure_frames = 1.5})[1]}, {{0, 2.0 / 3, 1.0 / 3, 0, 0}});
  expect_shares(shares_of({.frames_per_pattern = 2, .exposure_frames = 1.5}), whole({0, 1, 2, 3, 4}));
}

TEST(Timing, AWheelMeasuredLateHasItsFirstPrimaryFromTheNextPattern) {
  const Timing wheel{.exposure_delay_frames = 0.5, .colour_wheel = true};
  // Open from 0.5 to 1.5: red of [0, 1/3) is the next pattern's; green of [1/3, 2/3) half of each; blue this.
  expect_shares({shares_of(wheel, 0, 0)[1]}, {{0, 0, 1, 0, 0}});
  expect_shares({shares_of(wheel, 0, 1)[1]}, {{0, 0.5, 0.5, 0, 0}});
  expect_shares({shares_of(wheel, 0, 2)[1]}, {{0, 1, 0, 0, 0}});
}

TEST(Timing, AThirdOfAFrameIsOnePrimaryThreeTimesAsBright) {
  const Timing wheel{.exposure_frames = 1.0 / 3, .colour_wheel = true};
  expect_shares({shares_of(wheel, 0, 0)[3]}, {{0, 0, 0, 3, 0}});
  expect_shares({shares_of(wheel, 0, 1)[3]}, {{0, 0, 0, 0, 0}});
}

// Light of each value through its bit planes, for one pattern of one pixel row.
std::vector<double> light_of_values(const Timing& timing) {
  PatternStack ramp{256, 1, 1, {}};
  for (int v = 0; v < 256; ++v) ramp.values.push_back(std::uint8_t(v));
  const PatternStack planes = bit_planes(ramp);
  EXPECT_EQ(planes.count, 8);
  const std::vector<double> shares = shares_of(make_timeline(timing, 1, 1, true), 0, 0, 8)[0];
  std::vector<double> light(256, 0.0);
  for (int v = 0; v < 256; ++v)
    for (int plane = 0; plane < 8; ++plane) light[v] += shares[plane] * planes.texel(v, 0)[plane] / 255;
  return light;
}

TEST(Timing, AWholeFrameOfBitPlanesIsTheValue) {
  const std::vector<double> light = light_of_values({.bit_planes = true});
  for (int v = 0; v < 256; ++v) EXPECT_NEAR(light[v], v / 255.0, 1e-6);  // single precision
}

TEST(Timing, SevenTenthsOfAFrameSeeTwoBits) {
  const std::vector<double> light = light_of_values({.exposure_frames = 0.7, .bit_planes = true});
  const double bit7 = 128 / 255.0 / 0.7, bit6 = (0.7 - 128 / 255.0) / 0.7;
  for (int v = 0; v < 256; ++v)
    EXPECT_NEAR(light[v], (v & 128 ? bit7 : 0) + (v & 64 ? bit6 : 0), 1e-6);  // single precision
  EXPECT_NEAR(light[255], 1, 1e-6);                                           // white and black stay
  EXPECT_EQ(light[0], 0);
}

TEST(Timing, ThirteenTenthsOfAFrameCountTheHighestBitMore) {
  const std::vector<double> light =
      light_of_values({.frames_per_pattern = 2, .exposure_frames = 1.3, .bit_planes = true});
  for (int v = 0; v < 256; ++v)
    EXPECT_NEAR(light[v], (v / 255.0 + (v & 128 ? 0.3 : 0)) / 1.3, 1e-6);  // single precision
}

TEST(Timing, BitPlanesAreOfTheLightAndOnlyGreysNeedThem) {
  PatternStack stack{2, 1, 1, {255, 100}};
  EXPECT_TRUE(has_greys({&stack, 1}));
  stack.light_of_value[100] = 129.0f / 255;  // as a response would
  EXPECT_THAT(bit_planes(stack).values,
              ::testing::ElementsAre(255, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 0, 0, 0, 255));
  stack.values = {0, 255};
  EXPECT_FALSE(has_greys({&stack, 1}));
}

TEST(Timing, PicturesOfARollingShutterMixWhatTheyMeet) {
  Scene scene = testing::facing_plane();
  scene.ambient_lx = 5;
  const ImageStack<float> frames = testing::played(scene);
  scene.effects.timing = true;
  scene.timing = {.dropped_frame = 4, .rolling_shutter_frames = 0.5};
  const ImageStack<float> pictures = testing::played(scene);
  ASSERT_EQ(pictures.count, frames.count);
  const auto shown = [&](int due) { return std::min(frames.count - 1, due + (due >= 4)); };
  for (int k = 0; k < pictures.count; ++k) {
    const auto now = frames.picture(shown(k)), next = frames.picture(shown(k + 1));
    for (std::size_t p = 0; p < pictures.picture_size(); ++p) {
      const double share = 0.5 * double(p / 60) / 39, expected = (1 - share) * now[p] + share * next[p];
      EXPECT_NEAR(pictures.picture(k)[p], expected, 1e-6 * expected);  // single precision
    }
  }
}

TEST(Timing, AWheelShowsGreyPatternsPrimaryByPrimary) {
  Scene scene = testing::facing_plane();
  const ImageStack<float> frames = testing::played(scene);
  scene.effects.timing = scene.effects.colour = true;
  scene.cameras[0].colour_filter = ColourFilter::bayer_rggb;
  scene.timing = {.exposure_delay_frames = 0.5, .colour_wheel = true};
  const ImageStack<float> pictures = testing::played(scene);
  const double of_next[] = {1, 0.5, 0};
  for (int k = 0; k + 1 < pictures.count; ++k) {
    for (std::size_t p = 0; p < pictures.picture_size(); ++p) {
      const int channel = int(p % 60 % 2 + p / 60 % 2);  // of RGGB
      const double expected =
          of_next[channel] * frames.picture(k + 1)[p] + (1 - of_next[channel]) * frames.picture(k)[p];
      EXPECT_NEAR(pictures.picture(k)[p], expected, 1e-6 * expected);  // single precision
    }
  }
}

TEST(Timing, BitPlanesOfASlideComeBeforeTheBlackLevel) {
  Scene scene = testing::facing_plane();
  const ImageStack<float> frames = testing::played(scene);
  scene.effects.slide = scene.effects.timing = scene.effects.black_level = true;
  scene.projectors[0].effects.black_level = 0.1;
  scene.slide = testing::plain_slide({100, 80}, glm::vec3(0), 128 / 255.0f);
  scene.timing = {.exposure_frames = 0.5, .bit_planes = true};  // within the highest bit
  const ImageStack<float> pictures = testing::played(scene);
  ASSERT_EQ(pictures.count, 1);
  for (std::size_t p = 0; p < pictures.picture_size(); ++p)
    EXPECT_NEAR(pictures.picture(0)[p], frames.picture(frames.count - 2)[p],
                2e-6f * pictures.picture(0)[p]);  // a sum in single precision
}

TEST(Timing, WithoutFaultsThereIsNoTimeline) {
  EXPECT_FALSE(make_timeline({}, 5, 3, false).frames_of_row);
  EXPECT_FALSE(make_timeline({.moved = {"camera", 2}}, 5, 3, false).frames_of_row);
}

TEST(Timing, RefusesPicturesBeyondTheSequence) {
  const auto error = [](const Timing& timing) {
    return testing::input_error([&] { make_timeline(timing, 5, 3, false); });
  };
  EXPECT_EQ(error({.dropped_frame = 5}),
            "[timing]: dropped_frame is 5, expected a picture of the sequence, 0 to 4");
  EXPECT_THAT(error({.repeated_frame = 99}), ::testing::HasSubstr("repeated_frame is 99"));
  EXPECT_THAT(error({.moved = {"camera", 7}}), ::testing::HasSubstr("from_picture of moved is 7"));
}

}  // namespace
}  // namespace laterna
