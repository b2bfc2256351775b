#include "calib/decode_gray.h"

#include "sim/image_file.h"
#include "sim/parallel.h"
#include "sim/pattern.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <opencv2/structured_light.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

namespace laterna {
namespace {

using ::testing::HasSubstr;

const GrayDecodeOptions opencv_rule{40, 5, 0, 0};

// The pictures of a camera that looks straight at the panel, pixel upon pixel.
ImageStack<std::uint8_t> seen_straight(glm::ivec2 size) {
  const GraySequence sequence{size};
  ImageStack<std::uint8_t> stack(size.x, size.y, picture_count(sequence));
  for (int k = 0; k < stack.count; ++k)
    std::ranges::copy(pattern_picture(sequence, k).values, stack.picture(k).begin());
  return stack;
}

std::uint8_t clamp_dn(double value) { return std::uint8_t(std::lround(std::clamp(value, 0.0, 255.0))); }

// Contrast falls to nothing from left to right, and each value has Gaussian noise.
ImageStack<std::uint8_t> faded_and_noisy(glm::ivec2 size, double sigma_dn, std::mt19937_64& random) {
  ImageStack<std::uint8_t> stack = seen_straight(size);
  std::normal_distribution<double> noise(0, sigma_dn);
  for (int k = 0; k < stack.count; ++k) {
    for (std::size_t i = 0; i < stack.picture_size(); ++i) {
      const double contrast = 1 - double(i % stack.width) / stack.width;
      stack.picture(k)[i] = clamp_dn(20 + 0.8 * contrast * stack.picture(k)[i] + noise(random));
    }
  }
  return stack;
}

cv::Mat mat_of(ImageStack<std::uint8_t>& stack, int k) {
  return {stack.height, stack.width, CV_8UC1, stack.picture(k).data()};
}

TEST(DecodeGray, InvertsEncodingAtEveryProjectorPixel) {
  for (const glm::ivec2 size :
       {glm::ivec2(1, 1), glm::ivec2(2, 3), glm::ivec2(64, 48), glm::ivec2(321, 77)}) {
    const DecodedMap map = decode_gray(seen_straight(size), size);
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        ASSERT_EQ(map.valid(x, y), 1);
        ASSERT_EQ(map.u_px(x, y), x);
        ASSERT_EQ(map.v_px(x, y), y);
        ASSERT_FLOAT_EQ(map.sigma_px(x, y), std::sqrt(1 / 12.0f));
        ASSERT_FLOAT_EQ(map.confidence(x, y), 1);
      }
    }
  }
}

TEST(DecodeGray, PatternsEqualOpenCvs) {
  for (const glm::ivec2 size :
       {glm::ivec2(1024, 768), glm::ivec2(1280, 800), glm::ivec2(1920, 1080), glm::ivec2(37, 19)}) {
    const auto peer = cv::structured_light::GrayCodePattern::create(size.x, size.y);
    std::vector<cv::Mat> pictures;
    ASSERT_TRUE(peer->generate(pictures));
    const GraySequence sequence{size};
    ASSERT_EQ(picture_count(sequence), int(pictures.size()) + 2);  // white and black come on top
    for (std::size_t k = 0; k < pictures.size(); ++k) {
      const Image<std::uint8_t> ours = pattern_picture(sequence, int(k));
      const cv::Mat view(size.y, size.x, CV_8UC1, const_cast<std::uint8_t*>(ours.values.data()));
      ASSERT_EQ(cv::norm(view, pictures[k], cv::NORM_INF), 0) << size.x << "x" << size.y << " picture " << k;
    }
  }
}

TEST(DecodeGray, EqualsOpenCvOnNoisyPictures) {
  auto random = testing::generator();
  const glm::ivec2 size(200, 150);
  ImageStack<std::uint8_t> stack = faded_and_noisy(size, 4, random);
  const auto peer = cv::structured_light::GrayCodePattern::create(size.x, size.y);
  peer->setBlackThreshold(40), peer->setWhiteThreshold(5);
  std::vector<cv::Mat> pictures;
  for (int k = 0; k + 2 < stack.count; ++k) pictures.push_back(mat_of(stack, k));
  const cv::Mat white = mat_of(stack, stack.count - 2), black = mat_of(stack, stack.count - 1);
  const DecodedMap map = decode_gray(CapturedStack(stack), size, opencv_rule);
  int valid = 0;
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      cv::Point pixel;
      const bool contrast =
          white.at<std::uint8_t>(y, x) - black.at<std::uint8_t>(y, x) > 40;  // its decode() asks this apart
      const bool peer_valid =
          contrast && !peer->getProjPixel(pictures, x, y, pixel);  // it returns true on error
      ASSERT_EQ(map.valid(x, y) != 0, peer_valid) << x << " " << y;
      valid += peer_valid;
      if (!peer_valid) continue;
      ASSERT_EQ(map.u_px(x, y), pixel.x);
      ASSERT_EQ(map.v_px(x, y), pixel.y);
    }
  }
  EXPECT_GT(valid, 5000);
  EXPECT_LT(valid, 25000);  // and some are refused
}

TEST(DecodeGray, NoiseIsRefusedRatherThanDecodedWrongly) {
  auto random = testing::generator();
  const glm::ivec2 size(256, 128);
  const DecodedMap map = decode_gray(faded_and_noisy(size, 6, random), size);
  int valid = 0, wrong = 0;
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      if (!map.valid(x, y)) {
        EXPECT_TRUE(std::isnan(map.u_px(x, y)) && std::isnan(map.v_px(x, y)) &&
                    std::isnan(map.sigma_px(x, y)));
        continue;
      }
      ++valid;
      wrong += map.u_px(x, y) != x || map.v_px(x, y) != y;
    }
  }
  EXPECT_GT(valid, 15000);
  EXPECT_EQ(wrong, 0);  // a pair must differ by 5 sigmas: a flipped bit needs 10, beyond 1e-20
}

TEST(DecodeGray, NoiseIsMeasured) {
  auto random = testing::generator();
  for (const double sigma : {4.0, 8.0}) {
    // ±10 %: some 4000 samples give 2 %, rounding to whole DN adds 1/√12, and the median of whole numbers
    // steps by 0.74 DN / sigma.
    EXPECT_NEAR(picture_noise_dn(faded_and_noisy({256, 128}, sigma, random), 10), std::hypot(sigma, 0.29),
                0.1 * sigma + 0.05);
  }
  ImageStack<std::uint8_t> black(4, 4, 6);
  std::fill(black.values.begin(), black.values.end(), std::uint8_t{0});
  EXPECT_EQ(picture_noise_dn(black, 10), 0);
}

TEST(DecodeGray, SixteenBitsDecodeAsEight) {
  const glm::ivec2 size(64, 48);
  const ImageStack<std::uint8_t> narrow = seen_straight(size);
  ImageStack<std::uint16_t> wide(narrow.width, narrow.height, narrow.count);
  std::transform(narrow.values.begin(), narrow.values.end(), wide.values.begin(),
                 [](std::uint8_t v) { return std::uint16_t(v * 257); });
  const DecodedMap a = decode_gray(narrow, size), b = decode_gray(wide, size);
  EXPECT_EQ(a.u_px.values, b.u_px.values);
  EXPECT_EQ(a.valid.values, b.valid.values);
}

TEST(DecodeGray, CodesOutsideTheProjectorAreNotValid) {
  // A 5 pixel wide panel needs 3 bits; seen through the patterns of 8 columns, columns 5 to 7 are no pixels
  // of it.
  const DecodedMap map = decode_gray(seen_straight({8, 4}), {5, 4});
  EXPECT_EQ(map.valid(4, 0), 1);
  EXPECT_EQ(map.valid(5, 0), 0);
  EXPECT_EQ(map.valid(7, 3), 0);
}

TEST(DecodeGray, SameBitsForAnyNumberOfThreads) {
  auto random = testing::generator();
  const CapturedStack stack = faded_and_noisy({100, 60}, 5, random);
  set_thread_count(1);
  const DecodedMap one = decode_gray(stack, {100, 60});
  set_thread_count(7);
  const DecodedMap seven = decode_gray(stack, {100, 60});
  set_thread_count(0);
  EXPECT_EQ(one.valid.values, seven.valid.values);
  EXPECT_EQ(one.confidence.values, seven.confidence.values);
}

TEST(DecodeGray, RefusesAWrongNumberOfPictures) {
  EXPECT_THAT(testing::input_error([] {
                decode_gray(seen_straight({64, 48}), {128, 48});
              }),
              HasSubstr("26"));  // 2·6 + 2·6 + 2
  EXPECT_THAT(testing::input_error([] {
                decode_gray(ImageStack<std::uint8_t>{}, {128, 48});
              }),
              ::testing::Not(::testing::IsEmpty()));
}

// The real capture of the public sample data: 42 pictures, projector 1024×768.
std::optional<CapturedStack> real_capture() {
  const char* captures = std::getenv("LATERNA_CAPTURES");
  if (!captures) return {};
  const auto folder = std::filesystem::path(captures) / "graycode-procam-kamino/capture_0";
  if (!std::filesystem::exists(folder)) return {};
  std::vector<std::filesystem::path> files;
  for (int k = 0; k < 42; ++k) files.push_back(folder / fmt::format("graycode_{:02}.png", k));
  return read_stack(files);
}

TEST(DecodeGray, RealCaptureDecodesAsItsReadmeSays) {
  const auto stack = real_capture();
  if (!stack) GTEST_SKIP() << "LATERNA_CAPTURES does not name a folder with graycode-procam-kamino/capture_0";
  const DecodedMap map =
      decode_gray(*stack, {1024, 768}, {40, 6, 0, 0});  // its README: |pattern - inverse| > 5, in whole DN
  const auto valid = std::count(map.valid.values.begin(), map.valid.values.end(), std::uint8_t{1});
  EXPECT_NEAR(100.0 * double(valid) / double(map.valid.values.size()), 53.8, 0.05);  // given to one decimal
}

}  // namespace
}  // namespace laterna
