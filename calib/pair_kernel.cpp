#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "calib/pair_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "calib/pair_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace laterna::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <class D>
HWY_INLINE void store_codes(D d, hn::Vec<D> codes, std::uint8_t* to) {
  if constexpr (sizeof(hn::TFromD<D>) == 1) {
    hn::StoreU(codes, d, to);
  } else {
    const hn::Rebind<std::uint8_t, D> bytes;
    const hn::Rebind<std::int16_t, D> whole;  // below 256: narrowing saturates nothing
    hn::StoreU(hn::DemoteTo(bytes, hn::BitCast(whole, codes)), bytes, to);
  }
}

// `vectors` neighbouring ones at a time: as many bytes of each picture in a row.
template <int vectors, class D, class T>
HWY_INLINE void read_at(D d, const T* const* pattern, const T* const* inverse, int pairs, std::size_t i,
                        std::uint8_t* codes, T* weakest) {
  hn::Vec<D> code[vectors], least[vectors];
  const std::size_t lanes = hn::Lanes(d);
  for (int n = 0; n < vectors; ++n)
    code[n] = hn::Zero(d), least[n] = hn::LoadU(d, weakest + i + std::size_t(n) * lanes);
  for (int k = 0; k < pairs; ++k) {
    for (int n = 0; n < vectors; ++n) {
      const std::size_t at = i + std::size_t(n) * lanes;
      const auto a = hn::LoadU(d, pattern[k] + at), b = hn::LoadU(d, inverse[k] + at);
      const auto above = hn::SaturatedSub(a, b), below = hn::SaturatedSub(b, a);
      const auto bit = hn::IfThenElse(hn::Eq(above, hn::Zero(d)), hn::Zero(d), hn::Set(d, T{1}));
      code[n] = hn::Add(hn::Add(code[n], code[n]), bit);
      least[n] = hn::Min(least[n], hn::Or(above, below));
    }
  }
  for (int n = 0; n < vectors; ++n) {
    store_codes(d, code[n], codes + i + std::size_t(n) * lanes);
    hn::StoreU(least[n], d, weakest + i + std::size_t(n) * lanes);
  }
}

template <class T>
HWY_INLINE void read_all(const T* const* pattern, const T* const* inverse, int pairs, std::size_t count,
                         std::uint8_t* codes, T* weakest) {
  const hn::ScalableTag<T> wide;
  const hn::CappedTag<T, 1> single;
  const std::size_t lanes = hn::Lanes(wide);
  std::size_t i = 0;
  for (; i + 4 * lanes <= count; i += 4 * lanes) read_at<4>(wide, pattern, inverse, pairs, i, codes, weakest);
  for (; i < count; ++i) read_at<1>(single, pattern, inverse, pairs, i, codes, weakest);
}

void read_pairs_8(const std::uint8_t* const* pattern, const std::uint8_t* const* inverse, int pairs,
                  std::size_t count, std::uint8_t* codes, std::uint8_t* weakest) {
  read_all(pattern, inverse, pairs, count, codes, weakest);
}
void read_pairs_16(const std::uint16_t* const* pattern, const std::uint16_t* const* inverse, int pairs,
                   std::size_t count, std::uint8_t* codes, std::uint16_t* weakest) {
  read_all(pattern, inverse, pairs, count, codes, weakest);
}

template <class D>
HWY_INLINE void stripes_at(D d, hn::Vec<D> mask, int base, int low_bits, const std::uint8_t* high,
                           const std::uint8_t* low, std::uint16_t* stripe) {
  const hn::Rebind<std::uint8_t, D> bytes;
  const auto upper = hn::ShiftLeftSame(hn::PromoteTo(d, hn::LoadU(bytes, high)), low_bits);
  auto w = hn::Or(upper, hn::PromoteTo(d, hn::LoadU(bytes, low)));
  const auto bit = hn::And(hn::ShiftRightSame(w, base), hn::Set(d, std::uint16_t{1}));
  w = hn::Xor(w, hn::And(mask, hn::Sub(hn::Zero(d), bit)));
  w = hn::Xor(w, hn::ShiftRight<1>(w));
  w = hn::Xor(w, hn::ShiftRight<2>(w));
  w = hn::Xor(w, hn::ShiftRight<4>(w));
  hn::StoreU(hn::Xor(w, hn::ShiftRight<8>(w)), d, stripe);
}

void stripes_of_words_16(std::uint16_t mask, int base, int low_bits, const std::uint8_t* high,
                         const std::uint8_t* low, std::size_t count, std::uint16_t* stripe) {
  const hn::ScalableTag<std::uint16_t> wide;
  const hn::CappedTag<std::uint16_t, 1> single;
  std::size_t i = 0;
  for (; i + hn::Lanes(wide) <= count; i += hn::Lanes(wide))
    stripes_at(wide, hn::Set(wide, mask), base, low_bits, high + i, low + i, stripe + i);
  for (; i < count; ++i)
    stripes_at(single, hn::Set(single, mask), base, low_bits, high + i, low + i, stripe + i);
}

template <class D, class T>
HWY_INLINE void judge_at(D d, const T* white, const T* black, const T* weakest, const std::uint16_t* column,
                         const std::uint16_t* row, const PairLimits& limits, std::uint8_t* valid) {
  const hn::Rebind<std::int32_t, D> whole;
  const auto load = [&](const auto* from) {
    const hn::Rebind<std::remove_cvref_t<decltype(*from)>, D> narrow;
    return hn::PromoteTo(whole, hn::LoadU(narrow, from));
  };
  const auto contrast = hn::ConvertTo(d, hn::Sub(load(white), load(black)));
  const auto least = hn::ConvertTo(d, load(weakest));
  const auto bright = hn::And(hn::Gt(contrast, hn::Set(d, limits.white_minus_black)),
                              hn::Ge(least, hn::Set(d, limits.pair_difference)));
  const auto distinct = hn::And(bright, hn::Ge(least, hn::Mul(hn::Set(d, limits.pair_fraction), contrast)));
  const auto inside = hn::And(hn::Lt(load(column), hn::Set(whole, limits.columns)),
                              hn::Lt(load(row), hn::Set(whole, limits.rows)));
  const auto good = hn::And(hn::RebindMask(whole, distinct), inside);
  const hn::Rebind<std::uint8_t, D> bytes;
  hn::StoreU(hn::DemoteTo(bytes, hn::IfThenElseZero(good, hn::Set(whole, 1))), bytes, valid);
}

template <class T>
HWY_INLINE void judge_all(const T* white, const T* black, const T* weakest, const std::uint16_t* column,
                          const std::uint16_t* row, const PairLimits& limits, std::size_t count,
                          std::uint8_t* valid) {
  const hn::ScalableTag<float> wide;
  const hn::CappedTag<float, 1> single;
  std::size_t i = 0;
  for (; i + hn::Lanes(wide) <= count; i += hn::Lanes(wide))
    judge_at(wide, white + i, black + i, weakest + i, column + i, row + i, limits, valid + i);
  for (; i < count; ++i)
    judge_at(single, white + i, black + i, weakest + i, column + i, row + i, limits, valid + i);
}

void judge_pairs_8(const std::uint8_t* white, const std::uint8_t* black, const std::uint8_t* weakest,
                   const std::uint16_t* column, const std::uint16_t* row, const PairLimits& limits,
                   std::size_t count, std::uint8_t* valid) {
  judge_all(white, black, weakest, column, row, limits, count, valid);
}
void judge_pairs_16(const std::uint16_t* white, const std::uint16_t* black, const std::uint16_t* weakest,
                    const std::uint16_t* column, const std::uint16_t* row, const PairLimits& limits,
                    std::size_t count, std::uint8_t* valid) {
  judge_all(white, black, weakest, column, row, limits, count, valid);
}

}  // namespace
}  // namespace laterna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace laterna {

HWY_EXPORT(read_pairs_8);
HWY_EXPORT(read_pairs_16);
HWY_EXPORT(stripes_of_words_16);
HWY_EXPORT(judge_pairs_8);
HWY_EXPORT(judge_pairs_16);

void read_pairs(const std::uint8_t* const* pattern, const std::uint8_t* const* inverse, int pairs,
                std::size_t count, std::uint8_t* codes, std::uint8_t* weakest) {
  HWY_DYNAMIC_DISPATCH(read_pairs_8)(pattern, inverse, pairs, count, codes, weakest);
}
void read_pairs(const std::uint16_t* const* pattern, const std::uint16_t* const* inverse, int pairs,
                std::size_t count, std::uint8_t* codes, std::uint16_t* weakest) {
  HWY_DYNAMIC_DISPATCH(read_pairs_16)(pattern, inverse, pairs, count, codes, weakest);
}

void stripes_of_words(std::uint16_t mask, int base, int low_bits, const std::uint8_t* high,
                      const std::uint8_t* low, std::size_t count, std::uint16_t* stripe) {
  HWY_DYNAMIC_DISPATCH(stripes_of_words_16)(mask, base, low_bits, high, low, count, stripe);
}

void judge_pairs(const std::uint8_t* white, const std::uint8_t* black, const std::uint8_t* weakest,
                 const std::uint16_t* column, const std::uint16_t* row, const PairLimits& limits,
                 std::size_t count, std::uint8_t* valid) {
  HWY_DYNAMIC_DISPATCH(judge_pairs_8)(white, black, weakest, column, row, limits, count, valid);
}
void judge_pairs(const std::uint16_t* white, const std::uint16_t* black, const std::uint16_t* weakest,
                 const std::uint16_t* column, const std::uint16_t* row, const PairLimits& limits,
                 std::size_t count, std::uint8_t* valid) {
  HWY_DYNAMIC_DISPATCH(judge_pairs_16)(white, black, weakest, column, row, limits, count, valid);
}

}  // namespace laterna
#endif
