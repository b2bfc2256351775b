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

template <class D, class T>
HWY_INLINE void read_at(D d, const T* const* pattern, const T* const* inverse, int pairs, std::size_t i,
                        std::uint8_t* codes, T* weakest) {
  auto code = hn::Zero(d), least = hn::LoadU(d, weakest + i);
  for (int k = 0; k < pairs; ++k) {
    const auto a = hn::LoadU(d, pattern[k] + i), b = hn::LoadU(d, inverse[k] + i);
    const auto above = hn::SaturatedSub(a, b), below = hn::SaturatedSub(b, a);
    const auto bit = hn::IfThenElse(hn::Eq(above, hn::Zero(d)), hn::Zero(d), hn::Set(d, T{1}));
    code = hn::Add(hn::Add(code, code), bit);
    least = hn::Min(least, hn::Or(above, below));
  }
  store_codes(d, code, codes + i);
  hn::StoreU(least, d, weakest + i);
}

template <class T>
HWY_INLINE void read_all(const T* const* pattern, const T* const* inverse, int pairs, std::size_t count,
                         std::uint8_t* codes, T* weakest) {
  const hn::ScalableTag<T> wide;
  const hn::CappedTag<T, 1> single;
  std::size_t i = 0;
  for (; i + hn::Lanes(wide) <= count; i += hn::Lanes(wide))
    read_at(wide, pattern, inverse, pairs, i, codes, weakest);
  for (; i < count; ++i) read_at(single, pattern, inverse, pairs, i, codes, weakest);
}

void read_pairs_8(const std::uint8_t* const* pattern, const std::uint8_t* const* inverse, int pairs,
                  std::size_t count, std::uint8_t* codes, std::uint8_t* weakest) {
  read_all(pattern, inverse, pairs, count, codes, weakest);
}
void read_pairs_16(const std::uint16_t* const* pattern, const std::uint16_t* const* inverse, int pairs,
                   std::size_t count, std::uint8_t* codes, std::uint16_t* weakest) {
  read_all(pattern, inverse, pairs, count, codes, weakest);
}

}  // namespace
}  // namespace laterna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace laterna {

HWY_EXPORT(read_pairs_8);
HWY_EXPORT(read_pairs_16);

void read_pairs(const std::uint8_t* const* pattern, const std::uint8_t* const* inverse, int pairs,
                std::size_t count, std::uint8_t* codes, std::uint8_t* weakest) {
  HWY_DYNAMIC_DISPATCH(read_pairs_8)(pattern, inverse, pairs, count, codes, weakest);
}
void read_pairs(const std::uint16_t* const* pattern, const std::uint16_t* const* inverse, int pairs,
                std::size_t count, std::uint8_t* codes, std::uint16_t* weakest) {
  HWY_DYNAMIC_DISPATCH(read_pairs_16)(pattern, inverse, pairs, count, codes, weakest);
}

}  // namespace laterna
#endif
