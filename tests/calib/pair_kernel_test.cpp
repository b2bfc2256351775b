// The kernels of binary codes against plain loops; 1,037 pixels leave a tail for every vector length.
#include "calib/pair_kernel.h"

#include "tests/testing.h"

#include <gtest/gtest.h>

#include <vector>

namespace laterna {
namespace {

using testing::generator;

constexpr std::size_t count = 1037;

template <class T>
std::vector<T> random_values(int below, std::mt19937_64& random) {
  std::uniform_int_distribution<int> value(0, below - 1);
  std::vector<T> values(count);
  for (T& v : values) v = T(value(random));
  return values;
}

TEST(PairKernel, StripesAreThoseOfAPlainLoop) {
  auto random = generator();
  const auto high = random_values<std::uint8_t>(8, random), low = random_values<std::uint8_t>(256, random);
  for (const auto& [mask, base] : {std::pair(0, 0), std::pair(0x6fe, 0), std::pair(0x5fb, 2)}) {
    std::vector<std::uint16_t> stripe(count);
    stripes_of_words(std::uint16_t(mask), base, 8, high.data(), low.data(), count, stripe.data());
    for (std::size_t i = 0; i < count; ++i) {
      unsigned word = high[i] * 256u + low[i];
      if (word >> base & 1) word ^= unsigned(mask);
      unsigned binary = 0;
      for (unsigned rest = word; rest; rest >>= 1) binary ^= rest;  // binary_from_gray by its definition
      ASSERT_EQ(stripe[i], binary) << i;
    }
  }
}

template <class T>
void expect_plain_verdicts(int below, const PairLimits& limits) {
  auto random = generator();
  const auto white = random_values<T>(below, random), black = random_values<T>(below, random),
             weakest = random_values<T>(below, random);
  const auto column = random_values<std::uint16_t>(1200, random),
             row = random_values<std::uint16_t>(1200, random);
  std::vector<std::uint8_t> valid(count, 7);
  judge_pairs(white.data(), black.data(), weakest.data(), column.data(), row.data(), limits, count,
              valid.data());
  std::size_t good = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float contrast = float(int(white[i]) - int(black[i])), least = weakest[i];
    const bool expected = contrast > limits.white_minus_black && least >= limits.pair_difference &&
                          least >= limits.pair_fraction * contrast && column[i] < limits.columns &&
                          row[i] < limits.rows;
    ASSERT_EQ(valid[i], expected) << i;
    good += expected;
  }
  EXPECT_GT(good, count / 20);  // both verdicts are there
  EXPECT_LT(good, count / 2);
}

TEST(PairKernel, VerdictsOf8BitsAreThoseOfAPlainLoop) {
  expect_plain_verdicts<std::uint8_t>(256, {40, 30, 0.5f, 1024, 768});
}

TEST(PairKernel, VerdictsOf16BitsAreThoseOfAPlainLoop) {
  expect_plain_verdicts<std::uint16_t>(65536, {9000.5f, 7000, 0.5f, 1024, 768});
}

}  // namespace
}  // namespace laterna
