#include "calib/pair_codes.h"

#include "calib/pair_kernel.h"

#include <array>

namespace laterna {

namespace {

constexpr std::size_t block_pixels = 4096;  // its words stay in the first-level cache

/// stripe = binary_from_gray(word ^ (bit `base` of word ? mask : 0)), on 16 bits.
void stripes_of(const WordCode& code, const std::uint8_t* high, const std::uint8_t* low, int low_bits,
                std::size_t count, std::uint16_t* stripe) {
  const auto mask = std::uint16_t(code.mask);
  for (std::size_t i = 0; i < count; ++i) {
    auto w = std::uint16_t(high[i] << low_bits | low[i]);
    w = std::uint16_t(w ^ (mask & -(w >> code.base & 1)));
    w = std::uint16_t(w ^ (w >> 1));
    w = std::uint16_t(w ^ (w >> 2));
    w = std::uint16_t(w ^ (w >> 4));
    stripe[i] = std::uint16_t(w ^ (w >> 8));
  }
}

}  // namespace

template <class T>
PairPictures<T>::PairPictures(const ImageStackView<T>& stack, const PatternSequence& sequence, int axis)
    : code(word_code(sequence, axis)) {
  for (const PatternGroup& group : pattern_groups(sequence)) {
    if (group.axis != axis || group.kind != PatternGroup::Kind::pair) continue;
    pattern.push_back(stack.picture(group.first).data());
    inverse.push_back(stack.picture(group.first + 1).data());
  }
}

template <class T>
void PairPictures<T>::read(std::size_t begin, std::size_t count, std::uint16_t* stripe, T* weakest) const {
  std::array<std::uint8_t, block_pixels> bytes[2];
  const int bits = int(pattern.size()), low_bits = std::min(bits, 8), high_bits = bits - low_bits;
  for (std::size_t done = 0; done < count; done += block_pixels) {
    const std::size_t n = std::min(block_pixels, count - done);
    const T *from_pattern[16], *from_inverse[16];
    for (int k = 0; k < bits; ++k) {
      from_pattern[k] = pattern[k] + begin + done;
      from_inverse[k] = inverse[k] + begin + done;
    }
    read_pairs(from_pattern, from_inverse, high_bits, n, bytes[0].data(), weakest + done);
    read_pairs(from_pattern + high_bits, from_inverse + high_bits, low_bits, n, bytes[1].data(),
               weakest + done);
    stripes_of(code, bytes[0].data(), bytes[1].data(), low_bits, n, stripe + done);
  }
}

template struct PairPictures<std::uint8_t>;
template struct PairPictures<std::uint16_t>;

}  // namespace laterna
