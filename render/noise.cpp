// Loops over the pixels of a block, which compilers vectorise. Only operations that round alike everywhere:
// integers, + - · / and the square root, and nothing is contracted.
#include "render/noise.h"

#include "sim/instruction_sets.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

namespace laterna {

namespace {

constexpr int n = noise_pixels;

struct Counter {
  std::uint32_t a, b, c, d;
};

inline void mix(std::uint32_t& x, std::uint32_t& y, int turn) {
  x += y;
  y = std::rotl(y, turn) ^ x;
}

/// Threefry4x32-16: sixteen rounds of add, turn and exclusive or, a key added after every fourth.
inline Counter threefry(Counter x, const std::uint32_t* keys) {
  x.a += keys[0], x.b += keys[1], x.c += keys[2], x.d += keys[3];
  for (int j = 1; j <= 4; ++j) {
    const bool odd = j % 2 == 1;
    mix(x.a, x.b, odd ? 10 : 6), mix(x.c, x.d, odd ? 26 : 20);
    mix(x.a, x.d, odd ? 11 : 17), mix(x.c, x.b, odd ? 21 : 11);
    mix(x.a, x.b, odd ? 13 : 25), mix(x.c, x.d, odd ? 27 : 10);
    mix(x.a, x.d, odd ? 23 : 18), mix(x.c, x.b, odd ? 5 : 20);
    x.a += keys[j % 5], x.b += keys[(j + 1) % 5], x.c += keys[(j + 2) % 5];
    x.d += keys[(j + 3) % 5] + std::uint32_t(j);
  }
  return x;
}

/// -ln(x/2³¹) for x in [1/2, 2³¹]: x = 2^e·m with m in [√½, √2), and ln m = 2·artanh s with
/// s = (m-1)/(m+1), |s| < 0.172; the first term left out is s⁸/9 < 9e-8 of the sum.
inline float minus_log_share(float x) {
  constexpr std::uint32_t root_half = 0x3f3504f3;  // the bits of √½
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x) - root_half;
  const int exponent = std::bit_cast<std::int32_t>(bits) >> 23;
  const float m = std::bit_cast<float>((bits & 0x7fffff) + root_half);
  const float s = (m - 1) / (m + 1), q = s * s;
  const float log_m = 2 * s * (1 + q * (1 / 3.f + q * (1 / 5.f + q * (1 / 7.f))));
  return float(31 - exponent) * std::numbers::ln2_v<float> - log_m;
}

/// Two deviates: the radius √(-2·ln u) with u = (a/2 + 1/2)/2³¹, and a direction whose quarter turn is two
/// bits of b, its angle t within ±π/4 the others. Taylor's series of sin t and cos t end before t¹¹/11! and
/// t¹⁰/10!, 3e-8.
inline void box_muller(std::uint32_t a, std::uint32_t b, float& first, float& second) {
  const float minus_log = minus_log_share(float(std::int32_t(a >> 1)) + 0.5f);
  const float radius = std::sqrt(2 * (minus_log > 0 ? minus_log : 0.f));
  const float t = float(std::bit_cast<std::int32_t>(b << 2)) * (std::numbers::pi_v<float> / 4 * 0x1p-31f);
  const float q = t * t;
  const float sine = t * (1 - q * (1 / 6.f - q * (1 / 120.f - q * (1 / 5040.f - q * (1 / 362880.f)))));
  const float cosine = 1 - q * (1 / 2.f - q * (1 / 24.f - q * (1 / 720.f - q * (1 / 40320.f))));
  const bool swap = (b >> 30 & 1) != 0;
  const float turned = (b >> 31) != 0 ? -radius : radius;
  first = turned * (swap ? sine : cosine);
  second = turned * (swap ? cosine : sine);
}

/// e⁻ˣ for x in [0, 30]: 2^-k·e^r with |r| ≤ ln 2 / 2; Taylor's series of e^r ends before r⁸/8!, 5e-9.
inline float exp_minus(float x) {
  const int k = int(x * std::numbers::log2e_v<float> + 0.5f);
  const float r = float(k) * 0.693145751953125f - x + float(k) * 1.42860677e-6f;  // ln 2 in two parts
  const float e =
      1 +
      r * (1 + r * (1 / 2.f + r * (1 / 6.f + r * (1 / 24.f + r * (1 / 120.f + r * (1 / 720.f + r / 5040))))));
  return e * std::bit_cast<float>((127 - k) << 23);
}

/// Where the tail of a Poisson distribution is cut: at least 6.5 deviations and 4 counts above the mean, for
/// 2·√(10.56·μ) ≤ 10.56 + μ.
inline float last_count(float mean) { return 2 * mean + 14.6f; }

constexpr std::array<float, 80> reciprocals = [] {
  std::array<float, 80> values{};
  for (int i = 1; i < 80; ++i) values[i] = 1 / float(i);
  return values;
}();

}  // namespace

LATERNA_CLONES void random_words(const NoiseKey& key, NoiseStream stream, std::uint32_t first_pixel,
                                 std::uint32_t group, std::uint32_t* words) {
  const auto low = std::uint32_t(key.seed), high = std::uint32_t(key.seed >> 32);
  const std::uint32_t keys[5] = {low, high, key.camera, key.projector,
                                 0x1BD11BDA ^ low ^ high ^ key.camera ^ key.projector};
  for (int i = 0; i < n; ++i) {
    const Counter x = threefry({first_pixel + std::uint32_t(i), group, std::uint32_t(stream), 0}, keys);
    words[i] = x.a, words[n + i] = x.b, words[2 * n + i] = x.c, words[3 * n + i] = x.d;
  }
}

namespace {

LATERNA_CLONES void transform(const std::uint32_t* words, float* deviates) {
  for (int i = 0; i < n; ++i) box_muller(words[i], words[n + i], deviates[i], deviates[n + i]);
}

}  // namespace

void normal_deviates(const NoiseKey& key, NoiseStream stream, std::uint32_t first_pixel, std::uint32_t group,
                     float* deviates) {
  std::uint32_t words[noise_values];
  random_words(key, stream, first_pixel, group, words);
  transform(words, deviates);
  transform(words + 2 * n, deviates + 2 * n);
}

LATERNA_CLONES void poisson_counts(const float* means, const std::uint32_t* words, float* counts) {
  constexpr float below_one = 1 - 0x1p-24f, negligible = 1e-30f;  // the latter keeps denormals away
  constexpr int steps = 4;
  float mean[n], chance[n], below[n], uniform[n], last[n];
  int going_on = 0;
  for (int i = 0; i < n; ++i) {
    mean[i] = means[i] > 0 && means[i] < greatest_poisson_mean ? means[i] : 0;
    below[i] = chance[i] = exp_minus(mean[i]);
    const float drawn = (float(std::int32_t(words[i] >> 1)) + 0.5f) * 0x1p-31f;
    uniform[i] = drawn < below_one ? drawn : below_one;
    last[i] = last_count(mean[i]);
    counts[i] = 0;
    going_on |= int(uniform[i] >= below[i]);
  }
  for (int k = 1; going_on != 0; k += steps) {
    going_on = 0;
    for (int i = 0; i < n; ++i) {
      float sum = below[i], term = chance[i], count = counts[i];
      for (int j = 0; j < steps; ++j) {
        count += uniform[i] >= sum && float(k + j) <= last[i] ? 1.f : 0.f;
        const float next = term * (mean[i] * reciprocals[k + j]);
        term = next > negligible ? next : negligible;
        sum += term;
      }
      below[i] = sum, chance[i] = term, counts[i] = count;
      going_on |= int(uniform[i] >= sum) & int(float(k + steps) <= last[i]);
    }
  }
}

}  // namespace laterna
