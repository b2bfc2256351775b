#include "render/noise.h"

#include "tests/testing.h"

#include <Random123/threefry.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

namespace laterna {
namespace {

constexpr auto temporal = NoiseStream::temporal;
using Words = std::array<std::uint32_t, noise_values>;
using Deviates = std::array<float, noise_values>;

Words words_of(const NoiseKey& key, NoiseStream stream, std::uint32_t pixel, std::uint32_t group) {
  Words words{};
  random_words(key, stream, pixel, group, words.data());
  return words;
}

Deviates deviates_of(const NoiseKey& key, NoiseStream stream, std::uint32_t pixel, std::uint32_t group) {
  Deviates deviates{};
  normal_deviates(key, stream, pixel, group, deviates.data());
  return deviates;
}

// A million deviates: `pictures` of 4096·64 pixels, pixel by pixel.
std::vector<float> drawn_picture(const NoiseKey& key, int picture, int blocks = 4096) {
  std::vector<float> all;
  for (int b = 0; b < blocks; ++b) {
    const Deviates d = deviates_of(key, temporal, b * noise_pixels, picture / 4);
    all.insert(all.end(), d.begin() + picture % 4 * noise_pixels,
               d.begin() + (picture % 4 + 1) * noise_pixels);
  }
  return all;
}

TEST(RandomWords, AreThoseOfThePublishedGenerator) {
  const NoiseKey key{0x123456789abcdef0, 3, 4};
  const Words words = words_of(key, NoiseStream::shot, 0xffffffe0, 77);
  for (std::uint32_t i = 0; i < noise_pixels; ++i) {
    const auto published =
        r123::Threefry4x32_R<12>()({{0xffffffe0 + i, 77, 1, 0}}, {{0x9abcdef0, 0x12345678, 3, 4}});
    for (int j = 0; j < 4; ++j) ASSERT_EQ(words[j * noise_pixels + i], published[j]);
  }
}

TEST(NormalDeviates, AreBoxAndMullersTransformOfTheWords) {
  double worst = 0;
  for (std::uint32_t b = 0; b < 500; ++b) {
    const Words words = words_of({testing::seed(), 1, 2}, temporal, b * noise_pixels, b);
    const Deviates deviates = deviates_of({testing::seed(), 1, 2}, temporal, b * noise_pixels, b);
    for (int i = 0; i < noise_values; ++i) {
      if (i / noise_pixels % 2 == 1) continue;
      const std::uint32_t second = words[i + noise_pixels];
      const double u = double(float(words[i] >> 1) + 0.5f) / 2147483648.0;  // as a float holds it
      const double quarter = double(std::int32_t(second << 2)) / 2147483648.0 * std::numbers::pi / 4;
      const double radius = std::sqrt(-2 * std::log(u)) * (second >> 31 ? -1 : 1);
      double x = radius * std::cos(quarter), y = radius * std::sin(quarter);
      if (second >> 30 & 1) std::swap(x, y);
      worst = std::max({worst, std::abs(deviates[i] - x), std::abs(deviates[i + noise_pixels] - y)});
    }
  }
  EXPECT_LT(worst, 2e-6);  // roundings of a radius up to 6.7, some 5e-7
}

TEST(NormalDeviates, MomentsAndTailsOfAMillion) {
  double sums[5] = {}, beyond_two = 0, beyond_four = 0, greatest = 0;
  for (int picture = 0; picture < 4; ++picture) {
    for (const double x : drawn_picture({testing::seed(), 0, 0}, picture)) {
      for (int power = 1; power <= 4; ++power) sums[power] += std::pow(x, power);
      beyond_two += std::abs(x) > 2, beyond_four += std::abs(x) > 4;
      greatest = std::max(greatest, std::abs(x));
    }
  }
  // Five standard errors each: of x, x², x³, x⁴ and of counts, from the moments 1, 3, 15 and 105.
  const double n = 4 * 4096 * noise_pixels, e = 5 / std::sqrt(n);
  EXPECT_NEAR(sums[1] / n, 0, e);
  EXPECT_NEAR(sums[2] / n, 1, e * std::sqrt(2));
  EXPECT_NEAR(sums[3] / n, 0, e * std::sqrt(15));
  EXPECT_NEAR(sums[4] / n, 3, e * std::sqrt(96));
  EXPECT_NEAR(beyond_two / n, std::erfc(std::numbers::sqrt2), e * std::sqrt(0.0455));
  EXPECT_NEAR(beyond_four / n, std::erfc(2 * std::numbers::sqrt2), e * std::sqrt(6.33e-5));
  EXPECT_GT(greatest, 4.2);  // missed by a million with a chance of 1e-12
  EXPECT_LT(greatest, 6.67);
}

TEST(NormalDeviates, FillEqualBinsEvenly) {
  constexpr int bins = 200;
  for (int picture = 0; picture < 4; ++picture) {
    std::vector<double> counts(bins, 0.0);
    const std::vector<float> drawn = drawn_picture({testing::seed(), 0, 0}, picture);
    for (const double x : drawn)
      ++counts[std::min(bins - 1, int(bins * 0.5 * std::erfc(-x / std::numbers::sqrt2)))];
    const double expected = double(drawn.size()) / bins;
    double chi_squared = 0;
    for (const double count : counts) chi_squared += (count - expected) * (count - expected) / expected;
    // 199 degrees of freedom: mean 199, standard deviation 20; five of them either way.
    EXPECT_NEAR(chi_squared, 199, 100);
  }
}

TEST(NormalDeviates, NeighboursAreUncorrelated) {
  std::vector<std::vector<float>> pictures;
  for (int picture = 0; picture < 6; ++picture)
    pictures.push_back(drawn_picture({testing::seed(), 0, 0}, picture, 1024));
  const auto check = [](const std::vector<float>& a, const std::vector<float>& b, std::size_t lag) {
    double product = 0, of_squares = 0;
    const std::size_t n = a.size() - lag;
    for (std::size_t i = 0; i < n; ++i) {
      product += a[i] * b[i + lag];
      of_squares += (a[i] * a[i] - 1) * (b[i + lag] * b[i + lag] - 1);
    }
    // Five standard errors: the products have the deviations 1 and 2.
    EXPECT_NEAR(product / double(n), 0, 5 / std::sqrt(double(n)));
    EXPECT_NEAR(of_squares / double(n), 0, 10 / std::sqrt(double(n)));
  };
  for (const std::size_t lag : {1, 2, 3, 16, 63, 64, 1280}) check(pictures[0], pictures[0], lag);
  for (int k = 1; k < 6; ++k) {
    check(pictures[0], pictures[k], 0);
    check(pictures[0], pictures[k], 1);
  }
}

TEST(NormalDeviates, BelongToThePixelWhereverABlockBegins) {
  const Deviates whole = deviates_of({9, 1, 2}, temporal, 640, 3),
                 later = deviates_of({9, 1, 2}, temporal, 677, 3);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < noise_pixels - 37; ++i)
      ASSERT_EQ(whole[j * noise_pixels + i + 37], later[j * noise_pixels + i]);
}

TEST(NormalDeviates, EveryPartOfTheKeyCounts) {
  const Deviates base = deviates_of({1, 0, 0}, temporal, 5, 2);
  EXPECT_EQ(base, deviates_of({1, 0, 0}, temporal, 5, 2));
  EXPECT_NE(base, deviates_of({2, 0, 0}, temporal, 5, 2));
  EXPECT_NE(base, deviates_of({1 + (1ull << 32), 0, 0}, temporal, 5, 2));
  EXPECT_NE(base, deviates_of({1, 1, 0}, temporal, 5, 2));
  EXPECT_NE(base, deviates_of({1, 0, 1}, temporal, 5, 2));
  EXPECT_NE(base, deviates_of({1, 0, 0}, temporal, 6, 2));
  EXPECT_NE(base, deviates_of({1, 0, 0}, temporal, 5, 3));
  EXPECT_NE(base, deviates_of({1, 0, 0}, NoiseStream::shot, 5, 2));
}

// Found with SSE2, AVX2 and without vectors (-O1) alike.
TEST(NormalDeviates, TheSameBitsOnEveryMachine) {
  std::uint64_t hash = 0;
  for (std::uint32_t b = 0; b < 2000; ++b) {
    for (const float x : deviates_of({7, 1, 2}, temporal, b * noise_pixels, b))
      hash = hash * 1099511628211u + std::bit_cast<std::uint32_t>(x);
    const Words words = words_of({7, 1, 2}, NoiseStream::shot, b * noise_pixels, b);
    std::array<float, noise_pixels> means{}, counts{};
    for (int i = 0; i < noise_pixels; ++i) means[i] = 31.f * float(i) / 64 * (float(b % 7) / 6.f);
    poisson_counts(means.data(), words.data(), counts.data());
    for (const float x : counts) hash = hash * 1099511628211u + std::bit_cast<std::uint32_t>(x);
  }
  EXPECT_EQ(hash, 0x7140fcf3f3e09aeau);
}

// Counts of 200,000 pixels with one mean.
std::vector<int> drawn_counts(float mean) {
  std::vector<int> all;
  std::array<float, noise_pixels> means{}, counts{};
  means.fill(mean);
  for (std::uint32_t b = 0; b < 800; ++b) {
    const Words words = words_of({testing::seed(), 0, 0}, NoiseStream::shot, b * noise_pixels, 0);
    for (int j = 0; j < 4; ++j) {
      poisson_counts(means.data(), words.data() + j * noise_pixels, counts.data());
      for (const float count : counts) all.push_back(int(count));
    }
  }
  return all;
}

TEST(PoissonCounts, MeanVarianceAndDistribution) {
  for (const float mean : {0.01f, 0.3f, 1.f, 4.5f, 12.f, 29.99f}) {
    const std::vector<int> drawn = drawn_counts(mean);
    const double n = double(drawn.size());
    double sum = 0, squares = 0;
    std::vector<double> counts(100, 0.0);
    for (const int k : drawn) sum += k, squares += (k - mean) * (k - mean), ++counts.at(k);
    // Five standard errors; the fourth central moment of a Poisson distribution is μ + 3μ².
    EXPECT_NEAR(sum / n, mean, 5 * std::sqrt(mean / n)) << mean;
    EXPECT_NEAR(squares / n, mean, 5 * std::sqrt((mean + 2 * mean * mean) / n)) << mean;
    double chi_squared = 0, freedom = -1, chance = std::exp(-double(mean)), rest = n, seen = n;
    for (int k = 0; rest - n * chance > 20; ++k) {
      chi_squared += std::pow(counts[k] - n * chance, 2) / (n * chance);
      rest -= n * chance, seen -= counts[k], ++freedom;
      chance *= mean / (k + 1);
    }
    chi_squared += std::pow(seen - rest, 2) / rest, ++freedom;  // the tail as one bin
    ASSERT_GE(freedom, 1);
    EXPECT_LT(chi_squared, freedom + 5 * std::sqrt(2 * freedom) + 10)
        << mean;  // five deviations, and skewness
  }
}

TEST(PoissonCounts, NeighboursInABlockDoNotMatter) {
  const Words words = words_of({testing::seed(), 0, 0}, NoiseStream::shot, 0, 0);
  std::array<float, noise_pixels> dim{}, mixed{}, counts_dim{}, counts_mixed{};
  for (int i = 0; i < noise_pixels; ++i) dim[i] = 0.1f * float(i % 8), mixed[i] = i % 2 ? 1e6f : dim[i];
  mixed[1] = -5;
  poisson_counts(dim.data(), words.data(), counts_dim.data());
  poisson_counts(mixed.data(), words.data(), counts_mixed.data());
  for (int i = 0; i < noise_pixels; i += 2) EXPECT_EQ(counts_dim[i], counts_mixed[i]);
  EXPECT_EQ(counts_dim[0], 0);    // no light, no electron
  EXPECT_EQ(counts_mixed[1], 0);  // a negative mean is none
  EXPECT_EQ(counts_mixed[3], 0);  // nor is one that the function does not serve
}

}  // namespace
}  // namespace laterna
