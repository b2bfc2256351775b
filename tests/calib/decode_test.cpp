#include "calib/decode.h"

#include "calib/decode_report.h"
#include "sim/parallel.h"
#include "tests/calib/pictures.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using K = PatternKind;

std::string label(const PatternSequence& s) {
  return picture_name(s, 0) + " ... of " + std::to_string(picture_count(s)) + " pictures";
}

std::size_t valid_count(const DecodedMap& map) {
  return std::size_t(std::count(map.valid.values.begin(), map.valid.values.end(), std::uint8_t{1}));
}

// sqrt(mean(du² + dv²)) against the pixel's own place, for pictures seen straight.
double straight_rms_px(const DecodedMap& map) {
  double sum = 0;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      if (map.valid(x, y)) sum += std::pow(map.u_px(x, y) - x, 2) + std::pow(map.v_px(x, y) - y, 2);
  return std::sqrt(sum / double(valid_count(map)));
}

TEST(Decode, InvertsEveryFamilyAtEveryProjectorPixel) {
  for (const glm::ivec2 size : {glm::ivec2(320, 41), glm::ivec2(33, 200)}) {
    for (const PatternSequence& sequence : coded_families(size)) {
      const DecodedMap map = decode(straight(sequence), sequence);
      ASSERT_EQ(valid_count(map), std::size_t(size.x) * size.y) << label(sequence);
      for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
          // Patterns and pictures are whole DN: 0.41 DN over 127.5, at a period of 40 px 0.02 px; five
          // sigmas.
          ASSERT_NEAR(map.u_px(x, y), x, 0.1) << label(sequence);
          ASSERT_NEAR(map.v_px(x, y), y, 0.1) << label(sequence);
        }
      }
    }
  }
}

TEST(Decode, AnyNumberOfStepsAndAnyPitch) {
  for (const int steps : {3, 4, 5, 6, 9, 16}) {
    for (const double pitch : {3.0, 5.5, 17.0, 64.0, 500.0}) {
      const PatternSequence sequence{{.kind = K::gray_phase, .steps = steps, .pitch_px = pitch}, {90, 70}};
      const DecodedMap map = decode(straight(sequence), sequence);
      EXPECT_EQ(valid_count(map), 90u * 70) << steps << " " << pitch;
      EXPECT_LT(straight_rms_px(map), 0.001 + 0.001 * pitch)
          << steps << " " << pitch;  // rounding: 0.0007·pitch for N = 3
    }
  }
}

TEST(Decode, SixteenBitsDecodeAsEight) {
  const PatternSequence sequence{{.kind = K::multi_frequency, .pitch_px = 20}, {200, 60}};
  const ImageStack<std::uint8_t> narrow = straight(sequence);
  ImageStack<std::uint16_t> wide(narrow.width, narrow.height, narrow.count);
  std::transform(narrow.values.begin(), narrow.values.end(), wide.values.begin(),
                 [](std::uint8_t v) { return std::uint16_t(v * 16); });
  const DecodedMap a = decode(narrow, sequence), b = decode(wide, sequence);
  EXPECT_EQ(valid_count(b), valid_count(a));
  for (std::size_t i = 0; i < a.u_px.values.size(); ++i)
    ASSERT_NEAR(a.u_px.values[i], b.u_px.values[i], 1e-3);
}

TEST(Decode, SameBitsForAnyNumberOfThreads) {
  auto random = testing::generator();
  for (const PatternSequence& sequence : coded_families({120, 60})) {
    const CapturedStack stack = seen(
        sequence, {150, 90}, 1, [](glm::dvec2 p) { return 0.7 * p + 3.0; }, 3, random);
    set_thread_count(1);
    const DecodedMap one = decode(stack, sequence);
    set_thread_count(5);
    const DecodedMap five = decode(stack, sequence);
    set_thread_count(0);
    EXPECT_EQ(one.valid.values, five.valid.values);
    for (std::size_t i = 0; i < one.valid.values.size(); ++i) {
      if (!one.valid.values[i]) continue;
      ASSERT_EQ(one.u_px.values[i], five.u_px.values[i]);
      ASSERT_EQ(one.sigma_px.values[i], five.sigma_px.values[i]);
    }
  }
}

// Noise beyond what a sequence can bear is refused rather than decoded wrongly.
TEST(Decode, NoiseIsRefusedRatherThanDecodedWrongly) {
  auto random = testing::generator();
  for (const PatternSequence& sequence : coded_families({400, 60})) {
    std::normal_distribution<double> noise(0, 1);
    ImageStack<std::uint8_t> stack = straight(sequence);
    for (int k = 0; k < stack.count; ++k) {
      for (std::size_t i = 0; i < stack.picture_size(); ++i) {
        const double contrast = 1 - double(i % stack.width) / stack.width;  // falls to nothing
        stack.picture(k)[i] = clamp_dn(30 + 0.7 * contrast * stack.picture(k)[i] + 5 * noise(random));
      }
    }
    const DecodedMap map = decode(stack, sequence);
    std::size_t wrong = 0;
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x)
        wrong += map.valid(x, y) &&
                 std::hypot(map.u_px(x, y) - x, map.v_px(x, y) - y) > 10 * map.sigma_px(x, y) + 0.5;
    EXPECT_GT(valid_count(map), 1000u) << label(sequence);
    EXPECT_LE(wrong, valid_count(map) / 1000) << label(sequence);  // 4 sigmas of margin: fewer than 1 in 10⁴
  }
}

// (u - x)/sigma over a whole noisy map has a standard deviation of 1: with measured noise, for all families.
TEST(DecodePhase, ErrorsOverSigmaAreStandard) {
  auto random = testing::generator();
  for (const PatternSequence& sequence : coded_families({300, 100})) {
    if (sequence.parameters.kind == K::gray || sequence.parameters.kind == K::xor_gray) continue;
    std::normal_distribution<double> noise(0, 2.5);
    ImageStack<std::uint8_t> stack = straight(sequence);
    for (std::uint8_t& value : stack.values) value = clamp_dn(30 + 0.75 * value + noise(random));
    // The places are whole numbers, as boxes are: what decoding adds for those is taken off again.
    const DecodedMap map = decode(stack, sequence);
    double sum = 0, sigma2 = 0;
    double n = 0;
    for (int y = 2; y < 98; ++y) {  // the panel's edge has a sigma of its own
      for (int x = 2; x < 298; ++x) {
        if (!map.valid(x, y)) continue;
        ++n;
        sum += (std::pow(map.u_px(x, y) - x, 2) + std::pow(map.v_px(x, y) - y, 2)) / 2;
        sigma2 += std::pow(map.sigma_px(x, y), 2);
      }
    }
    const double rms2 = sum / n, predicted2 = sigma2 / n;
    const double r =
        std::exp(-2 * std::pow(std::numbers::pi, 2) * rms2);  // of a normal error about whole numbers
    EXPECT_NEAR(std::sqrt((predicted2 - r / 12) / rms2), 1, 0.1) << label(sequence);  // the bound
    EXPECT_GT(n, 0.99 * 296 * 96) << label(sequence);
  }
}

TEST(DecodePhase, SaturatedSamplesAreSolvedOrRejected) {
  // White at 1.5 × full scale: crests are cut off.
  const auto cut = [](double v) { return std::min(255.0, 10 + 1.5 * v); };
  const PatternSequence eight{{.kind = K::gray_phase, .steps = 8, .pitch_px = 32}, {320, 64}};
  const DecodedMap solved = decode(straight(eight, cut), eight);
  EXPECT_EQ(valid_count(solved), 320u * 64);
  EXPECT_LT(straight_rms_px(solved), 0.03);  // five samples of ±0.41 DN on 190: 0.01 px
  const PatternSequence three{{.kind = K::gray_phase, .steps = 3, .pitch_px = 32}, {320, 64}};
  const auto nick = [](double v) { return std::min(255.0, 10 + 1.1 * v); };
  const DecodedMap rejected = decode(straight(three, nick), three);
  EXPECT_LT(valid_count(rejected), 320u * 64 / 2);
  EXPECT_LT(straight_rms_px(rejected), 0.05);
  EXPECT_GT(std::count(rejected.why.values.begin(), rejected.why.values.end(), Reject::saturated),
            320 * 64 / 3);
  const DecodeReport report = report_on(straight(three, nick), three, rejected);
  EXPECT_THAT(report.flags, ::testing::Contains(HasSubstr("shorten the exposure")));
}

TEST(DecodePhase, BoxesAreToldFromBlur) {
  auto random = testing::generator();
  const PatternSequence sequence{{.kind = K::gray_phase, .steps = 4, .pitch_px = 32}, {120, 80}};
  const auto place = [](glm::dvec2 p) {
    return glm::dvec2(0.31 * p.x + 0.02 * p.y + 5, 0.29 * p.y - 0.03 * p.x + 14);
  };
  const auto rms_and_sigma = [&](int samples) {
    // 3.3 camera pixels per projector pixel; one sample sees boxes, many over a wide pixel see a slope.
    const auto wide = [&](glm::dvec2 p) {
      return place(samples == 1 ? p : glm::round(p) + 4.0 * (p - glm::round(p)));
    };
    const DecodedMap map = decode(seen(sequence, {300, 200}, samples, wide, 1, random), sequence);
    double sum = 0, sigma2 = 0;
    for (int y = 0; y < 200; ++y) {
      for (int x = 0; x < 300; ++x) {
        if (!map.valid(x, y)) continue;
        const glm::dvec2 d = glm::dvec2(map.u_px(x, y), map.v_px(x, y)) - place({x, y});
        sum += glm::dot(d, d) / 2, sigma2 += std::pow(map.sigma_px(x, y), 2);
      }
    }
    return glm::dvec2(std::sqrt(sum / double(valid_count(map))),
                      std::sqrt(sigma2 / double(valid_count(map))));
  };
  const glm::dvec2 boxes = rms_and_sigma(1), blurred = rms_and_sigma(8);
  EXPECT_NEAR(boxes.x, std::sqrt(1 / 12.0), 0.02);  // whole numbers, whatever the phase's noise
  EXPECT_NEAR(boxes.y / boxes.x, 1, 0.1);
  EXPECT_LT(blurred.x, 0.15);
}

TEST(Decode, RefusesBadInput) {
  for (const PatternSequence& sequence : coded_families({64, 48})) {
    const ImageStack<std::uint8_t> stack = straight(sequence);
    ImageStack<std::uint8_t> fewer(64, 48, stack.count - 1);
    std::copy_n(stack.values.begin(), fewer.values.size(), fewer.values.begin());
    EXPECT_THAT(testing::input_error([&] { decode(fewer, sequence); }),
                HasSubstr("expected " + std::to_string(stack.count)));
    EXPECT_THAT(testing::input_error([&] { decode(ImageStack<std::uint8_t>{}, sequence); }),
                HasSubstr("pictures"));
    DecodeOptions options;
    options.max_neighbour_step_px = std::nan("");
    EXPECT_THAT(testing::input_error([&] { decode(stack, sequence, options); }),
                HasSubstr("neighbours' step"));
  }
  const PatternSequence phase{{.kind = K::phase}, {64, 48}};
  PhaseDecodeOptions options;
  options.min_modulation_dn = -1;
  EXPECT_THAT(testing::input_error([&] { decode_phase(straight(phase), phase, options); }), HasSubstr("-1"));
  options = {.noise = SampleNoise{0, 0}};
  EXPECT_THAT(testing::input_error([&] { decode_phase(straight(phase), phase, options); }),
              HasSubstr("noise of 0"));
  const PatternSequence gray{{}, {64, 48}};
  EXPECT_THAT(testing::input_error([&] { decode_phase(straight(gray), gray); }), HasSubstr("another family"));
  EXPECT_THAT(testing::input_error([&] { decode_gray(straight(phase), phase); }),
              HasSubstr("another family"));
  EXPECT_THAT(testing::input_error([&] {
                decode(straight(gray), PatternSequence{{.kind = K::pictures}, {64, 48}});
              }),
              HasSubstr("tell no pixel its place"));
}

TEST(RejectSteep, DropsLoneJumpsAndKeepsEdges) {
  DecodedMap map(20, 10);
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 20; ++x) {
      map.u_px(x, y) = x < 10 ? x : 100 + x;  // a depth edge
      map.v_px(x, y) = y, map.valid(x, y) = 1;
    }
  }
  map.u_px(5, 5) += 16;
  reject_steep(map, 8);
  EXPECT_EQ(valid_count(map), 199u);
  EXPECT_EQ(map.why(5, 5), Reject::steep);
  EXPECT_TRUE(std::isnan(map.u_px(5, 5)));
}

}  // namespace
}  // namespace laterna
