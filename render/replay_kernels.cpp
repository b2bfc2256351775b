#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/replay_kernels.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/replay_kernels.h"

#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace laterna::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
constexpr std::size_t block = block_pixels;
using Wide = hn::CappedTag<float, 16>;
using Four = hn::CappedTag<float, 4>;
using Single = hn::CappedTag<float, 1>;

template <class D>
HWY_INLINE hn::Vec<D> floats(D d, const std::uint8_t* from) {
  const hn::Rebind<std::uint8_t, D> bytes;
  const hn::Rebind<std::int32_t, D> ints;
  return hn::ConvertTo(d, hn::PromoteTo(ints, hn::LoadU(bytes, from)));
}

// a + share·(b - a).
template <class D>
HWY_INLINE hn::Vec<D> between(D d, hn::Vec<D> a, hn::Vec<D> b, float share) {
  return hn::Add(a, hn::Mul(hn::Set(d, share), hn::Sub(b, a)));
}

// What one tap gathers for the patterns from k on, before its gain.
template <class D>
HWY_INLINE hn::Vec<D> gathered(D d, const BilinearTap& t, int k) {
  const auto upper = between(d, floats(d, t.a + k), floats(d, t.c + k), t.right);
  const auto lower = between(d, floats(d, t.d + k), floats(d, t.e + k), t.right);
  return between(d, upper, lower, t.below);
}

template <class D>
HWY_INLINE hn::Vec<D> gathered(D d, const NearestTap& t, int k) {
  return floats(d, t.texel + k);
}

template <class D>
HWY_INLINE hn::Vec<D> gathered(D d, const TableTap& t, int k) {
  const hn::Rebind<std::uint8_t, D> bytes;
  const hn::Rebind<std::int32_t, D> ints;
  const auto light = hn::GatherIndex(d, t.light, hn::PromoteTo(ints, hn::LoadU(bytes, t.texel + k)));
  return hn::Add(light, hn::LoadU(d, t.added + k));
}

template <class D, class Tap>
HWY_INLINE hn::Vec<D> add(D d, const Tap& t, int k, hn::Vec<D> total) {
  return hn::Add(total, hn::Mul(hn::Set(d, t.gain), gathered(d, t, k)));
}

template <class D>
HWY_INLINE hn::Vec<D> add(D d, const BitTap& t, int k, hn::Vec<D> total) {
  const hn::RebindToUnsigned<D> words;
  const auto lane_bit = hn::Shl(hn::Set(words, 1u), hn::Iota(words, 0));
  const auto bits = hn::And(hn::Set(words, std::uint32_t(t.code >> k)), lane_bit);
  const auto on = hn::MaskFromVec(hn::BitCast(d, hn::VecFromMask(words, hn::Eq(bits, lane_bit))));
  return hn::Add(total, hn::IfThenElseZero(on, hn::Set(d, t.gain)));
}

template <class D, class Tap>
HWY_INLINE void sum(D d, const Tap* begin, const Tap* end, int k, float* sums) {
  auto total = hn::Zero(d);
  for (const Tap* t = begin; t != end; ++t) total = add(d, *t, k, total);
  hn::StoreU(total, d, sums + k);
}

// True where there are enough patterns for whole vectors: the last may overlap those before, with the same
// result.
template <class D, class Tap>
HWY_INLINE bool sum_pixel(D d, const Tap* begin, const Tap* end, int count, float* sums) {
  const int lanes = int(hn::Lanes(d));
  if (count < lanes) return false;
  for (int k = 0; k + lanes <= count; k += lanes) sum(d, begin, end, k, sums);
  if (count % lanes != 0) sum(d, begin, end, count - lanes, sums);
  return true;
}

#if HWY_TARGET == HWY_SCALAR

// levels[k·64 + i] = base[i] + sums[i·stride + k].
HWY_INLINE void transpose(const float* sums, std::size_t stride, const float* base, int count,
                          float* levels) {
  for (std::size_t i = 0; i < block; ++i)
    for (int k = 0; k < count; ++k) levels[k * block + i] = base[i] + sums[i * stride + k];
}

#else

// Rows of four floats to columns.
HWY_INLINE void turn(hn::Vec<Four>& a, hn::Vec<Four>& b, hn::Vec<Four>& c, hn::Vec<Four>& e) {
  constexpr Four d;
  const auto ab = hn::InterleaveLower(d, a, b), ab_upper = hn::InterleaveUpper(d, a, b);
  const auto ce = hn::InterleaveLower(d, c, e), ce_upper = hn::InterleaveUpper(d, c, e);
  a = hn::ConcatLowerLower(d, ce, ab), b = hn::ConcatUpperUpper(d, ce, ab);
  c = hn::ConcatLowerLower(d, ce_upper, ab_upper), e = hn::ConcatUpperUpper(d, ce_upper, ab_upper);
}

// levels[k·64 + i] = base[i] + sums[i·stride + k], four by four.
HWY_INLINE void transpose(const float* sums, std::size_t stride, const float* base, int count,
                          float* levels) {
  constexpr Four d;
  for (std::size_t i = 0; i < block; i += 4) {
    const auto from = hn::LoadU(d, base + i);
    for (int k = 0; k < count; k += 4) {
      const float* s = sums + i * stride + k;
      auto a = hn::LoadU(d, s), b = hn::LoadU(d, s + stride), c = hn::LoadU(d, s + 2 * stride),
           e = hn::LoadU(d, s + 3 * stride);
      turn(a, b, c, e);
      float* to = levels + std::size_t(k) * block + i;
      hn::StoreU(hn::Add(from, a), d, to), hn::StoreU(hn::Add(from, b), d, to + block);
      hn::StoreU(hn::Add(from, c), d, to + 2 * block), hn::StoreU(hn::Add(from, e), d, to + 3 * block);
    }
  }
}

#endif

template <class Tap>
HWY_INLINE void sum_block(const Tap* taps, const std::uint32_t* first, const float* base, int pixels,
                          int count, float* scratch, float* levels) {
  const std::size_t stride = padded(count);
  for (int i = 0; i < pixels; ++i) {
    const Tap *begin = taps + first[i], *end = taps + first[i + 1];
    float* sums = scratch + i * stride;
    if (!sum_pixel(Wide(), begin, end, count, sums) && !sum_pixel(Four(), begin, end, count, sums))
      sum_pixel(Single(), begin, end, count, sums);
  }
  transpose(scratch, stride, base, count, levels);
}

#define LATERNA_SUM_TAPS(Tap, name)                                                                \
  void name(const Tap* taps, const std::uint32_t* first, const float* base, int pixels, int count, \
            float* scratch, float* levels) {                                                       \
    sum_block(taps, first, base, pixels, count, scratch, levels);                                  \
  }
LATERNA_SUM_TAPS(BilinearTap, sum_bilinear)
LATERNA_SUM_TAPS(NearestTap, sum_nearest)
LATERNA_SUM_TAPS(TableTap, sum_table)
LATERNA_SUM_TAPS(BitTap, sum_bits)
#undef LATERNA_SUM_TAPS

using Doubles = hn::CappedTag<double, 8>;

// floor(x + 1/2), clamped to the picture.
HWY_INLINE hn::Vec<hn::RebindToSigned<Doubles>> texel_of(hn::Vec<Doubles> at, int size) {
  const Doubles d;
  const auto inside =
      hn::Min(hn::Max(hn::Add(at, hn::Set(d, 0.5)), hn::Zero(d)), hn::Set(d, double(size - 1)));
  return hn::PromoteTo(hn::RebindToSigned<Doubles>(),
                       hn::DemoteTo(hn::Rebind<std::int32_t, Doubles>(), inside));
}

void nearest_codes(const BlockEntries& entries, const CodePicture& picture, std::uint64_t* codes,
                   float* white) {
  const Doubles d;
  const hn::RebindToUnsigned<Doubles> words;
  const hn::Rebind<float, Doubles> f;
  for (std::size_t i = 0; i < block; i += hn::Lanes(d)) {
    hn::Vec<Doubles> u, v, weight, rest;
    hn::LoadInterleaved4(d, entries.first + 4 * i, u, v, weight, rest);
    const auto column = hn::GatherIndex(words, picture.column_codes, texel_of(u, picture.width));
    const auto row = hn::GatherIndex(words, picture.row_codes, texel_of(v, picture.height));
    hn::StoreU(hn::Or(column, row), words, codes + i);
    const auto gain = hn::DemoteTo(f, hn::Mul(hn::Set(d, entries.scale), weight));
    hn::StoreU(hn::Add(hn::LoadU(f, white + i), hn::Mul(gain, hn::Set(f, 255.0f))), f, white + i);
  }
}

// The codes are cut into bytes first, so that 8 pictures share one load of them.
template <class Number>
HWY_INLINE void expand_block(const std::uint64_t* codes, const Number* off, const Number* on, int pixels,
                             int count, Planes<Number> out) {
  const hn::CappedTag<Number, block> d;
  alignas(64) Number differing[block], bytes[block], row[block];
  for (std::size_t i = 0; i < block; ++i) differing[i] = Number(on[i] ^ off[i]);
  for (int k0 = 0; k0 < count; k0 += 8) {
    for (std::size_t i = 0; i < block; ++i) bytes[i] = Number((codes[i] >> k0) & 0xffu);
    for (int k = k0; k < count && k < k0 + 8; ++k) {
      const auto bit = hn::Set(d, Number(1u << (k - k0)));
      Number* to = out.first + k * out.stride;
      Number* written = pixels == int(block) ? to : row;
      for (std::size_t i = 0; i < block; i += hn::Lanes(d)) {
        const auto is_on = hn::TestBit(hn::Load(d, bytes + i), bit);
        const auto change = hn::IfThenElseZero(is_on, hn::Load(d, differing + i));
        hn::StoreU(hn::Xor(hn::LoadU(d, off + i), change), d, written + i);
      }
      if (written == row) std::memcpy(to, row, pixels * sizeof(Number));
    }
  }
}

void expand_bits_8(const std::uint64_t* codes, const std::uint8_t* off, const std::uint8_t* on, int pixels,
                   int count, Planes<std::uint8_t> out) {
  expand_block(codes, off, on, pixels, count, out);
}
void expand_bits_16(const std::uint64_t* codes, const std::uint16_t* off, const std::uint16_t* on, int pixels,
                    int count, Planes<std::uint16_t> out) {
  expand_block(codes, off, on, pixels, count, out);
}

void stream_rows(const std::byte* from, std::size_t from_stride, std::size_t bytes, int count, std::byte* to,
                 std::size_t to_stride) {
  const hn::CappedTag<std::uint8_t, 64> d;
  const std::size_t lanes = hn::Lanes(d);
  for (int k = 0; k < count; ++k, from += from_stride, to += to_stride) {
    if (reinterpret_cast<std::uintptr_t>(to) % lanes != 0 || bytes % lanes != 0) {
      std::memcpy(to, from, bytes);
      continue;
    }
    const auto* source = reinterpret_cast<const std::uint8_t*>(from);
    auto* target = reinterpret_cast<std::uint8_t*>(to);
    for (std::size_t i = 0; i < bytes; i += lanes) hn::Stream(hn::LoadU(d, source + i), d, target + i);
  }
}

}  // namespace
}  // namespace laterna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace laterna {

namespace {
HWY_EXPORT(sum_bilinear);
HWY_EXPORT(sum_nearest);
HWY_EXPORT(sum_table);
HWY_EXPORT(sum_bits);
HWY_EXPORT(nearest_codes);
HWY_EXPORT(expand_bits_8);
HWY_EXPORT(expand_bits_16);
HWY_EXPORT(stream_rows);
}  // namespace

void sum_taps(const BilinearTap* taps, const std::uint32_t* first, const float* base, int pixels, int count,
              float* scratch, float* levels) {
  HWY_DYNAMIC_DISPATCH(sum_bilinear)(taps, first, base, pixels, count, scratch, levels);
}
void sum_taps(const NearestTap* taps, const std::uint32_t* first, const float* base, int pixels, int count,
              float* scratch, float* levels) {
  HWY_DYNAMIC_DISPATCH(sum_nearest)(taps, first, base, pixels, count, scratch, levels);
}
void sum_taps(const TableTap* taps, const std::uint32_t* first, const float* base, int pixels, int count,
              float* scratch, float* levels) {
  HWY_DYNAMIC_DISPATCH(sum_table)(taps, first, base, pixels, count, scratch, levels);
}
void sum_taps(const BitTap* taps, const std::uint32_t* first, const float* base, int pixels, int count,
              float* scratch, float* levels) {
  HWY_DYNAMIC_DISPATCH(sum_bits)(taps, first, base, pixels, count, scratch, levels);
}

void nearest_codes(const BlockEntries& entries, const CodePicture& picture, std::uint64_t* codes,
                   float* white) {
  HWY_DYNAMIC_DISPATCH(nearest_codes)(entries, picture, codes, white);
}

void expand_bits(const std::uint64_t* codes, const std::uint8_t* off, const std::uint8_t* on, int pixels,
                 int count, Planes<std::uint8_t> out) {
  HWY_DYNAMIC_DISPATCH(expand_bits_8)(codes, off, on, pixels, count, out);
}
void expand_bits(const std::uint64_t* codes, const std::uint16_t* off, const std::uint16_t* on, int pixels,
                 int count, Planes<std::uint16_t> out) {
  HWY_DYNAMIC_DISPATCH(expand_bits_16)(codes, off, on, pixels, count, out);
}

void stream_rows(const std::byte* from, std::size_t from_stride, std::size_t bytes, int count, std::byte* to,
                 std::size_t to_stride) {
  HWY_DYNAMIC_DISPATCH(stream_rows)(from, from_stride, bytes, count, to, to_stride);
}

void finish_streams() { hwy::FlushStream(); }

}  // namespace laterna
#endif
