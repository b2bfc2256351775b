// Only operations that round alike on every instruction set: integers, + - · / and the square root, and
// nothing is fused.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/noise.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/noise.h"

#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace laterna::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, noise_pixels>;
using Words = hn::RebindToUnsigned<Floats>;
using Ints = hn::RebindToSigned<Floats>;
using FloatV = hn::Vec<Floats>;
using WordV = hn::Vec<Words>;

constexpr Floats f;
constexpr Words w;
constexpr Ints s;

HWY_INLINE FloatV set(float x) { return hn::Set(f, x); }

// c0 + q·(c1 + q·(c2 + ...)).
HWY_INLINE FloatV series(FloatV, float last) { return set(last); }
template <class... Rest>
HWY_INLINE FloatV series(FloatV q, float first, Rest... rest) {
  return hn::Add(set(first), hn::Mul(q, series(q, rest...)));
}

template <int turn>
HWY_INLINE void mix(WordV& x, WordV& y) {
  x = hn::Add(x, y);
  y = hn::Xor(hn::RotateRight<32 - turn>(y), x);
}

template <int t0, int t1, int t2, int t3, int t4, int t5, int t6, int t7>
HWY_INLINE void four_rounds(WordV& a, WordV& b, WordV& c, WordV& d) {
  mix<t0>(a, b), mix<t1>(c, d);
  mix<t2>(a, d), mix<t3>(c, b);
  mix<t4>(a, b), mix<t5>(c, d);
  mix<t6>(a, d), mix<t7>(c, b);
}

HWY_INLINE void add_keys(const std::uint32_t* keys, int j, WordV& a, WordV& b, WordV& c, WordV& d) {
  a = hn::Add(a, hn::Set(w, keys[j % 5]));
  b = hn::Add(b, hn::Set(w, keys[(j + 1) % 5]));
  c = hn::Add(c, hn::Set(w, keys[(j + 2) % 5]));
  d = hn::Add(d, hn::Set(w, keys[(j + 3) % 5] + std::uint32_t(j)));
}

// Threefry4x32-12: twelve rounds of add, turn and exclusive or, a key added after every fourth.
HWY_INLINE void threefry(const std::uint32_t* keys, WordV& a, WordV& b, WordV& c, WordV& d) {
  add_keys(keys, 0, a, b, c, d);
  four_rounds<10, 26, 11, 21, 13, 27, 23, 5>(a, b, c, d), add_keys(keys, 1, a, b, c, d);
  four_rounds<6, 20, 17, 11, 25, 10, 18, 20>(a, b, c, d), add_keys(keys, 2, a, b, c, d);
  four_rounds<10, 26, 11, 21, 13, 27, 23, 5>(a, b, c, d), add_keys(keys, 3, a, b, c, d);
}

// The words of the pixels from first_pixel + i on.
HWY_INLINE void draw(const std::uint32_t* keys, std::uint32_t stream, std::uint32_t pixel,
                     std::uint32_t group, WordV& a, WordV& b, WordV& c, WordV& d) {
  a = hn::Iota(w, pixel), b = hn::Set(w, group), c = hn::Set(w, stream), d = hn::Zero(w);
  threefry(keys, a, b, c, d);
}

// -ln(x/2³¹) for x in [1/2, 2³¹]: x = 2^e·m with m in [√½, √2), and ln m = 2·artanh s with
// s = (m-1)/(m+1), |s| < 0.172; the first term left out is s⁸/9 < 9e-8 of the sum.
HWY_INLINE FloatV minus_log_share(FloatV x) {
  const WordV root_half = hn::Set(w, 0x3f3504f3);  // the bits of √½
  const WordV bits = hn::Sub(hn::BitCast(w, x), root_half);
  const auto exponent = hn::ShiftRight<23>(hn::BitCast(s, bits));
  const FloatV m = hn::BitCast(f, hn::Add(hn::And(bits, hn::Set(w, 0x7fffff)), root_half));
  const FloatV t = hn::Div(hn::Sub(m, set(1)), hn::Add(m, set(1)));
  const FloatV log_m = hn::Mul(hn::Add(t, t), series(hn::Mul(t, t), 1, 1 / 3.f, 1 / 5.f, 1 / 7.f));
  const FloatV halvings = hn::ConvertTo(f, hn::Sub(hn::Set(s, 31), exponent));
  return hn::Sub(hn::Mul(halvings, set(std::numbers::ln2_v<float>)), log_m);
}

// An unsigned word as a number in (0, 2³¹).
HWY_INLINE FloatV half_open(WordV word) {
  return hn::Add(hn::ConvertTo(f, hn::BitCast(s, hn::ShiftRight<1>(word))), set(0.5f));
}

// Two deviates: the radius √(-2·ln u) with u = (a/2 + 1/2)/2³¹, and a direction whose quarter turn is two
// bits of b, its angle t within ±π/4 the others. Taylor's series of sin t and cos t end before t¹¹/11! and
// t¹⁰/10!, 3e-8.
HWY_INLINE void box_muller(WordV a, WordV b, FloatV& first, FloatV& second) {
  const FloatV minus_log = hn::Max(minus_log_share(half_open(a)), set(0));
  const FloatV radius = hn::Sqrt(hn::Add(minus_log, minus_log));
  const FloatV turn = hn::ConvertTo(f, hn::BitCast(s, hn::ShiftLeft<2>(b)));
  const FloatV t = hn::Mul(turn, set(std::numbers::pi_v<float> / 4 * 0x1p-31f)), q = hn::Mul(t, t);
  const FloatV sine = hn::Mul(t, series(q, 1, -1 / 6.f, 1 / 120.f, -1 / 5040.f, 1 / 362880.f));
  const FloatV cosine = series(q, 1, -1 / 2.f, 1 / 24.f, -1 / 720.f, 1 / 40320.f);
  const auto swap =
      hn::MaskFromVec(hn::BitCast(f, hn::BroadcastSignBit(hn::BitCast(s, hn::ShiftLeft<1>(b)))));
  const FloatV turned = hn::BitCast(f, hn::Xor(hn::BitCast(w, radius), hn::And(b, hn::Set(w, 0x80000000u))));
  first = hn::Mul(turned, hn::IfThenElse(swap, sine, cosine));
  second = hn::Mul(turned, hn::IfThenElse(swap, cosine, sine));
}

// e⁻ˣ for x in [0, 30]: 2^-k·e^r with |r| ≤ ln 2 / 2; Taylor's series of e^r ends before r⁸/8!, 5e-9.
HWY_INLINE FloatV exp_minus(FloatV x) {
  const auto k = hn::ConvertTo(s, hn::Add(hn::Mul(x, set(std::numbers::log2e_v<float>)), set(0.5f)));
  const FloatV k_float = hn::ConvertTo(f, k);
  const FloatV r = hn::Add(hn::Sub(hn::Mul(k_float, set(0.693145751953125f)), x),
                           hn::Mul(k_float, set(1.42860677e-6f)));  // ln 2 in two parts
  const FloatV e = series(r, 1, 1, 1 / 2.f, 1 / 6.f, 1 / 24.f, 1 / 120.f, 1 / 720.f, 1 / 5040.f);
  return hn::Mul(e, hn::BitCast(f, hn::ShiftLeft<23>(hn::Sub(hn::Set(s, 127), k))));
}

// Where the tail of a Poisson distribution is cut: at least 6.5 deviations and 4 counts above the mean, for
// 2·√(10.56·μ) ≤ 10.56 + μ.
HWY_INLINE FloatV last_count(FloatV mean) { return hn::Add(hn::Add(mean, mean), set(14.6f)); }

void random_words(const std::uint32_t* keys, std::uint32_t stream, std::uint32_t first_pixel,
                  std::uint32_t group, std::uint32_t* words) {
  for (std::size_t i = 0; i < noise_pixels; i += hn::Lanes(w)) {
    WordV a, b, c, d;
    draw(keys, stream, first_pixel + std::uint32_t(i), group, a, b, c, d);
    hn::StoreU(a, w, words + i), hn::StoreU(b, w, words + noise_pixels + i);
    hn::StoreU(c, w, words + 2 * noise_pixels + i), hn::StoreU(d, w, words + 3 * noise_pixels + i);
  }
}

void normal_deviates(const std::uint32_t* keys, std::uint32_t stream, std::uint32_t first_pixel,
                     std::uint32_t group, float* deviates) {
  for (std::size_t i = 0; i < noise_pixels; i += hn::Lanes(w)) {
    WordV a, b, c, d;
    FloatV first, second;
    draw(keys, stream, first_pixel + std::uint32_t(i), group, a, b, c, d);
    box_muller(a, b, first, second);
    hn::StoreU(first, f, deviates + i), hn::StoreU(second, f, deviates + noise_pixels + i);
    box_muller(c, d, first, second);
    hn::StoreU(first, f, deviates + 2 * noise_pixels + i);
    hn::StoreU(second, f, deviates + 3 * noise_pixels + i);
  }
}

void poisson_counts(const float* means, const std::uint32_t* words, float* counts) {
  const FloatV below_one = set(1 - 0x1p-24f), negligible = set(1e-30f);  // the latter keeps denormals away
  for (std::size_t i = 0; i < noise_pixels; i += hn::Lanes(f)) {
    const FloatV given = hn::LoadU(f, means + i);
    const auto usable = hn::And(hn::Gt(given, set(0)), hn::Lt(given, set(greatest_poisson_mean)));
    const FloatV mean = hn::IfThenElseZero(usable, given), last = last_count(mean);
    const FloatV uniform = hn::Min(hn::Mul(half_open(hn::LoadU(w, words + i)), set(0x1p-31f)), below_one);
    FloatV term = exp_minus(mean), sum = term, count = set(0);
    for (int k = 1;; ++k) {
      const auto beyond = hn::And(hn::Ge(uniform, sum), hn::Le(set(float(k)), last));
      if (hn::AllFalse(f, beyond)) break;
      count = hn::Add(count, hn::IfThenElseZero(beyond, set(1)));
      term = hn::Max(hn::Mul(term, hn::Mul(mean, set(1 / float(k)))), negligible);
      sum = hn::Add(sum, term);
    }
    hn::StoreU(count, f, counts + i);
  }
}

}  // namespace
}  // namespace laterna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace laterna {

namespace {

HWY_EXPORT(random_words);
HWY_EXPORT(normal_deviates);
HWY_EXPORT(poisson_counts);

struct Keys {
  std::uint32_t word[5];
  explicit Keys(const NoiseKey& key)
      : word{std::uint32_t(key.seed), std::uint32_t(key.seed >> 32), key.camera, key.projector, 0} {
    word[4] = 0x1BD11BDA ^ word[0] ^ word[1] ^ word[2] ^ word[3];
  }
};

}  // namespace

void random_words(const NoiseKey& key, NoiseStream stream, std::uint32_t first_pixel, std::uint32_t group,
                  std::uint32_t* words) {
  HWY_DYNAMIC_DISPATCH(random_words)(Keys(key).word, std::uint32_t(stream), first_pixel, group, words);
}

void normal_deviates(const NoiseKey& key, NoiseStream stream, std::uint32_t first_pixel, std::uint32_t group,
                     float* deviates) {
  HWY_DYNAMIC_DISPATCH(normal_deviates)(Keys(key).word, std::uint32_t(stream), first_pixel, group, deviates);
}

void poisson_counts(const float* means, const std::uint32_t* words, float* counts) {
  HWY_DYNAMIC_DISPATCH(poisson_counts)(means, words, counts);
}

}  // namespace laterna
#endif
