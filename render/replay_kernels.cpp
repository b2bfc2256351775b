#include "render/replay_kernels.h"

#include "sim/instruction_sets.h"

#include <cstring>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#define LATERNA_INLINE inline __attribute__((always_inline))

namespace laterna {

namespace {

constexpr int block = block_pixels;
constexpr int lanes = 8;  // patterns that are summed together

using Bytes = std::uint8_t __attribute__((vector_size(8)));
using Words = std::uint16_t __attribute__((vector_size(16)));
using Ints = std::int32_t __attribute__((vector_size(32)));
using Floats = float __attribute__((vector_size(32)));

LATERNA_INLINE void load(const std::uint8_t* from, Floats& to) {
  Bytes bytes;
  std::memcpy(&bytes, from, sizeof bytes);
  to = __builtin_convertvector(__builtin_convertvector(__builtin_convertvector(bytes, Words), Ints), Floats);
}

// What one tap adds to the patterns k to k + 7, and to pattern k alone.
LATERNA_INLINE void add(const BilinearTap& t, int k, Floats& total) {
  Floats a, c, d, e;
  load(t.a + k, a), load(t.c + k, c), load(t.d + k, d), load(t.e + k, e);
  const Floats upper = a + t.right * (c - a), lower = d + t.right * (e - d);
  total += t.gain * (upper + t.below * (lower - upper));
}
LATERNA_INLINE void add(const BilinearTap& t, int k, float& total) {
  const auto a = float(t.a[k]), c = float(t.c[k]), d = float(t.d[k]), e = float(t.e[k]);
  const float upper = a + t.right * (c - a), lower = d + t.right * (e - d);
  total += t.gain * (upper + t.below * (lower - upper));
}

LATERNA_INLINE void add(const NearestTap& t, int k, Floats& total) {
  Floats texel;
  load(t.texel + k, texel);
  total += t.gain * texel;
}
LATERNA_INLINE void add(const NearestTap& t, int k, float& total) { total += t.gain * float(t.texel[k]); }

LATERNA_INLINE void add(const TableTap& t, int k, float& total) {
  total += t.gain * (t.light[t.texel[k]] + t.added[k]);
}
LATERNA_INLINE void add(const TableTap& t, int k, Floats& total) {
  Floats light;
  for (int j = 0; j < lanes; ++j) light[j] = t.light[t.texel[k + j]] + t.added[k + j];
  total += t.gain * light;
}

LATERNA_INLINE void add(const BitTap& t, int k, Floats& total) {
  constexpr Ints bit = {1, 2, 4, 8, 16, 32, 64, 128};
  std::int32_t gain_bits;
  std::memcpy(&gain_bits, &t.gain, sizeof gain_bits);
  const Ints code = static_cast<std::int32_t>((t.code >> k) & 0xffu) - Ints{};
  const Ints gain = ((code & bit) == bit) & gain_bits;
  total += reinterpret_cast<Floats>(gain);
}
LATERNA_INLINE void add(const BitTap& t, int k, float& total) { total += (t.code >> k) & 1u ? t.gain : 0.0f; }

template <class Total, class Tap>
LATERNA_INLINE void sum(const Tap* begin, const Tap* end, int k, float* sums) {
  Total total{};
  for (const Tap* t = begin; t != end; ++t) add(*t, k, total);
  std::memcpy(sums + k, &total, sizeof total);
}

// All patterns of one pixel. The last 8 may overlap those before, with the same result.
template <class Tap>
LATERNA_INLINE void sum_pixel(const Tap* begin, const Tap* end, int count, float* sums) {
  if (count < lanes) {
    for (int k = 0; k < count; ++k) sum<float>(begin, end, k, sums);
    return;
  }
  for (int k = 0; k + lanes <= count; k += lanes) sum<Floats>(begin, end, k, sums);
  if (count % lanes != 0) sum<Floats>(begin, end, count - lanes, sums);
}

using Four = float __attribute__((vector_size(16)));

LATERNA_INLINE Four load(const float* from) {
  Four v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

// levels[k·64 + i] = base[i] + sums[i·stride + k], four by four.
LATERNA_INLINE void transpose(const float* sums, int stride, const float* base, int count, float* levels) {
  for (int k = 0; k < count; k += 4) {
    for (int i = 0; i < block; i += 4) {
      const float* s = sums + i * stride + k;
      const Four a = load(s), b = load(s + stride), c = load(s + 2 * stride), d = load(s + 3 * stride);
      const Four ab0 = __builtin_shufflevector(a, b, 0, 4, 1, 5),
                 ab1 = __builtin_shufflevector(a, b, 2, 6, 3, 7);
      const Four cd0 = __builtin_shufflevector(c, d, 0, 4, 1, 5),
                 cd1 = __builtin_shufflevector(c, d, 2, 6, 3, 7);
      const Four row[4] = {
          __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5), __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7),
          __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5), __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7)};
      const Four from = load(base + i);
      for (int j = 0; j < 4; ++j) {
        const Four level = from + row[j];
        std::memcpy(levels + (k + j) * block + i, &level, sizeof level);
      }
    }
  }
}

template <class Tap>
LATERNA_INLINE void sum_block(const Tap* taps, const std::uint32_t* first, const float* base, int pixels,
                              int count, float* scratch, float* levels) {
  const int stride = padded(count);
  for (int i = 0; i < pixels; ++i)
    sum_pixel(taps + first[i], taps + first[i + 1], count, scratch + std::size_t(i) * stride);
  transpose(scratch, stride, base, count, levels);
}

// The codes are cut into bytes first, so that 8 pictures share one load of them.
template <class Number>
LATERNA_INLINE void expand_block(const std::uint64_t* codes, const Number* off, const Number* on, int pixels,
                                 int count, Planes<Number> out) {
  Number differing[block], bytes[block], row[block];
  for (int i = 0; i < block; ++i) differing[i] = Number(on[i] ^ off[i]);
  for (int k0 = 0; k0 < count; k0 += 8) {
    for (int i = 0; i < block; ++i) bytes[i] = Number((codes[i] >> k0) & 0xffu);
    for (int k = k0; k < count && k < k0 + 8; ++k) {
      const Number bit = Number(1u << (k - k0));
      for (int i = 0; i < block; ++i) {
        const Number mask = (bytes[i] & bit) == bit ? Number(~Number{0}) : Number{0};
        row[i] = Number(off[i] ^ (differing[i] & mask));
      }
      std::memcpy(out.first + k * out.stride, row, pixels == block ? sizeof row : pixels * sizeof(Number));
    }
  }
}

}  // namespace

LATERNA_CLONES void sum_taps(const BilinearTap* taps, const std::uint32_t* first, const float* base,
                             int pixels, int count, float* scratch, float* levels) {
  sum_block(taps, first, base, pixels, count, scratch, levels);
}
LATERNA_CLONES void sum_taps(const NearestTap* taps, const std::uint32_t* first, const float* base,
                             int pixels, int count, float* scratch, float* levels) {
  sum_block(taps, first, base, pixels, count, scratch, levels);
}
LATERNA_CLONES void sum_taps(const TableTap* taps, const std::uint32_t* first, const float* base, int pixels,
                             int count, float* scratch, float* levels) {
  sum_block(taps, first, base, pixels, count, scratch, levels);
}
LATERNA_CLONES void sum_taps(const BitTap* taps, const std::uint32_t* first, const float* base, int pixels,
                             int count, float* scratch, float* levels) {
  sum_block(taps, first, base, pixels, count, scratch, levels);
}

LATERNA_CLONES void expand_bits(const std::uint64_t* codes, const std::uint8_t* off, const std::uint8_t* on,
                                int pixels, int count, Planes<std::uint8_t> out) {
  expand_block(codes, off, on, pixels, count, out);
}
LATERNA_CLONES void expand_bits(const std::uint64_t* codes, const std::uint16_t* off, const std::uint16_t* on,
                                int pixels, int count, Planes<std::uint16_t> out) {
  expand_block(codes, off, on, pixels, count, out);
}

void stream_rows(const std::byte* from, std::size_t from_stride, std::size_t bytes, int count, std::byte* to,
                 std::size_t to_stride) {
  constexpr std::size_t line = 64;
  for (int k = 0; k < count; ++k, from += from_stride, to += to_stride) {
#ifdef __SSE2__
    if (reinterpret_cast<std::uintptr_t>(to) % line == 0 && bytes % line == 0) {
      for (std::size_t i = 0; i < bytes; i += sizeof(__m128i))
        _mm_stream_si128(reinterpret_cast<__m128i*>(to + i),
                         _mm_loadu_si128(reinterpret_cast<const __m128i*>(from + i)));
      continue;
    }
#endif
    std::memcpy(to, from, bytes);
  }
#ifdef __SSE2__
  _mm_sfence();
#endif
}

}  // namespace laterna
