#include "render/replay_kernels.h"

#include "sim/instruction_sets.h"

#include <cstring>

#define LATERNA_INLINE inline __attribute__((always_inline))

namespace laterna {

namespace {

constexpr int block = block_pixels;
constexpr int lanes = 16;  // patterns that are summed together

// sums[0..n-1] of one pixel, from pattern k on. n is a constant after inlining, but for fewer than 16 patterns.
LATERNA_INLINE void sum(const BilinearTap* begin, const BilinearTap* end, int k, int n, float* sums) {
  float total[lanes] = {};
  for (const BilinearTap* t = begin; t != end; ++t) {
    const std::uint8_t *a = t->a + k, *c = t->c + k, *d = t->d + k, *e = t->e + k;
    for (int j = 0; j < n; ++j) {
      const float upper = float(a[j]) + t->right * float(c[j] - a[j]);
      const float lower = float(d[j]) + t->right * float(e[j] - d[j]);
      total[j] += t->gain * (upper + t->below * (lower - upper));
    }
  }
  for (int j = 0; j < n; ++j) sums[k + j] = total[j];
}

LATERNA_INLINE void sum(const NearestTap* begin, const NearestTap* end, int k, int n, float* sums) {
  float total[lanes] = {};
  for (const NearestTap* t = begin; t != end; ++t) {
    const std::uint8_t* texel = t->texel + k;
    for (int j = 0; j < n; ++j) total[j] += t->gain * float(texel[j]);
  }
  for (int j = 0; j < n; ++j) sums[k + j] = total[j];
}

LATERNA_INLINE void sum(const BitTap* begin, const BitTap* end, int k, int n, float* sums) {
  float total[lanes] = {};
  for (const BitTap* t = begin; t != end; ++t) {
    const auto code = static_cast<std::uint32_t>(t->code >> k);
    for (int j = 0; j < n; ++j) total[j] += (code >> j) & 1u ? t->gain : 0.0f;
  }
  for (int j = 0; j < n; ++j) sums[k + j] = total[j];
}

// All patterns of one pixel. The last 16 may overlap those before, with the same result.
template <class Tap>
LATERNA_INLINE void sum_pixel(const Tap* begin, const Tap* end, int count, float* sums) {
  if (count < lanes) return sum(begin, end, 0, count, sums);
  for (int k = 0; k + lanes <= count; k += lanes) sum(begin, end, k, lanes, sums);
  if (count % lanes != 0) sum(begin, end, count - lanes, lanes, sums);
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
      const Four ab0 = __builtin_shufflevector(a, b, 0, 4, 1, 5), ab1 = __builtin_shufflevector(a, b, 2, 6, 3, 7);
      const Four cd0 = __builtin_shufflevector(c, d, 0, 4, 1, 5), cd1 = __builtin_shufflevector(c, d, 2, 6, 3, 7);
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

template <class Number>
LATERNA_INLINE void quantise_row(const float* level, float full_scale, Number* out) {
  for (int i = 0; i < block; ++i) {
    const float above = level[i] > 0 ? level[i] : 0;
    out[i] = Number(int((above < full_scale ? above : full_scale) + 0.5f));
  }
}

template <class Number>
LATERNA_INLINE void quantise_block(const float* levels, float full_scale, int pixels, int count,
                                   Planes<Number> out) {
  for (int k = 0; k < count; ++k) {
    Number row[block];
    quantise_row(levels + std::size_t(k) * block, full_scale, row);
    if (pixels == block) {
      std::memcpy(out.first + k * out.stride, row, sizeof row);
    } else {
      std::memcpy(out.first + k * out.stride, row, pixels * sizeof(Number));
    }
  }
}

// The codes are cut into bytes first, so that 8 pictures share one load of them.
template <class Number>
LATERNA_INLINE void expand_block(const std::uint64_t* codes, const Number* off, const Number* on, int pixels,
                                 int count, Planes<Number> out) {
  for (int k0 = 0; k0 < count; k0 += 8) {
    Number bytes[block], row[block];
    for (int i = 0; i < block; ++i) bytes[i] = Number((codes[i] >> k0) & 0xffu);
    for (int k = k0; k < count && k < k0 + 8; ++k) {
      const Number bit = Number(1u << (k - k0));
      for (int i = 0; i < block; ++i) row[i] = Number(bytes[i] & bit) != 0 ? on[i] : off[i];
      if (pixels == block) {
        std::memcpy(out.first + k * out.stride, row, sizeof row);
      } else {
        std::memcpy(out.first + k * out.stride, row, pixels * sizeof(Number));
      }
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
LATERNA_CLONES void sum_taps(const BitTap* taps, const std::uint32_t* first, const float* base, int pixels,
                             int count, float* scratch, float* levels) {
  sum_block(taps, first, base, pixels, count, scratch, levels);
}

LATERNA_CLONES void quantise(const float* levels, float full_scale, int pixels, int count,
                             Planes<std::uint8_t> out) {
  quantise_block(levels, full_scale, pixels, count, out);
}
LATERNA_CLONES void quantise(const float* levels, float full_scale, int pixels, int count,
                             Planes<std::uint16_t> out) {
  quantise_block(levels, full_scale, pixels, count, out);
}

LATERNA_CLONES void expand_bits(const std::uint64_t* codes, const std::uint8_t* off, const std::uint8_t* on,
                                int pixels, int count, Planes<std::uint8_t> out) {
  expand_block(codes, off, on, pixels, count, out);
}
LATERNA_CLONES void expand_bits(const std::uint64_t* codes, const std::uint16_t* off, const std::uint16_t* on,
                                int pixels, int count, Planes<std::uint16_t> out) {
  expand_block(codes, off, on, pixels, count, out);
}

}  // namespace laterna
