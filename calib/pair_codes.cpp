#include "calib/pair_codes.h"

#include "calib/pair_kernel.h"

#include <array>

namespace laterna {

namespace {

constexpr std::size_t block_pixels = 4096;  // its words stay in the first-level cache

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
    stripes_of_words(std::uint16_t(code.mask), code.base, low_bits, bytes[0].data(), bytes[1].data(), n,
                     stripe + done);
  }
}

template struct PairPictures<std::uint8_t>;
template struct PairPictures<std::uint16_t>;

}  // namespace laterna
