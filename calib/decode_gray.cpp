#include "calib/decode_gray.h"

#include "sim/error.h"
#include "sim/parallel.h"
#include "sim/pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace laterna {

namespace {

/// Pixels are decoded in segments of this many: their codes stay in the first-level cache while all pictures
/// stream past.
constexpr std::size_t segment_pixels = 4096;

/// The thresholds in the stack's own DN.
struct Limits {
  float white_minus_black, pair_difference, pair_fraction;
};

/// Codes and weakest pairs of one segment.
template <class T>
struct Segment {
  std::vector<std::uint16_t> column, row;
  std::vector<T> weakest;

  explicit Segment(std::size_t count)
      : column(count, 0), row(count, 0), weakest(count, std::numeric_limits<T>::max()) {}
};

/// code ← 2·code + (pattern > inverse), weakest ← min(weakest, |pattern - inverse|).
template <class T>
void append_bit(const T* __restrict pattern, const T* __restrict inverse, std::size_t count,
                std::uint16_t* __restrict code, T* __restrict weakest) {
  for (std::size_t i = 0; i < count; ++i) {
    const T a = pattern[i], b = inverse[i];
    code[i] = static_cast<std::uint16_t>(2 * code[i] + (a > b ? 1 : 0));
    const T difference = static_cast<T>(std::max(a, b) - std::min(a, b));
    weakest[i] = std::min(weakest[i], difference);
  }
}

/// binary_from_gray on 16 bits.
void decode_words(std::vector<std::uint16_t>& words) {
  for (std::uint16_t& word : words) {
    std::uint16_t w = word;
    w = static_cast<std::uint16_t>(w ^ (w >> 1));
    w = static_cast<std::uint16_t>(w ^ (w >> 2));
    w = static_cast<std::uint16_t>(w ^ (w >> 4));
    word = static_cast<std::uint16_t>(w ^ (w >> 8));
  }
}

template <class T>
Segment<T> read_codes(const ImageStack<T>& stack, const GraySequence& sequence, std::size_t begin,
                      std::size_t count) {
  Segment<T> segment(count);
  const int columns = column_bits(sequence), bits = columns + row_bits(sequence);
  for (int bit = 0; bit < bits; ++bit) {
    std::uint16_t* code = (bit < columns ? segment.column : segment.row).data();
    append_bit(stack.picture(2 * bit).data() + begin, stack.picture(2 * bit + 1).data() + begin, count, code,
               segment.weakest.data());
  }
  decode_words(segment.column);
  decode_words(segment.row);
  return segment;
}

/// Judges a segment's pixels and writes them to the map.
template <class T>
void judge(const Segment<T>& segment, const T* white, const T* black, const GraySequence& sequence,
           const Limits& limits, std::size_t begin, DecodedMap& map) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const float sigma = static_cast<float>(1 / std::sqrt(12.0));
  for (std::size_t i = 0; i < segment.weakest.size(); ++i) {
    const int column = segment.column[i], row = segment.row[i];
    const float contrast = static_cast<float>(white[i] - black[i]), weakest = segment.weakest[i];
    const bool valid = (contrast > limits.white_minus_black) & (weakest >= limits.pair_difference) &
                       (weakest >= limits.pair_fraction * contrast) & (column < sequence.projector_size.x) &
                       (row < sequence.projector_size.y);
    map.u_px.values[begin + i] = valid ? column : nan;
    map.v_px.values[begin + i] = valid ? row : nan;
    map.sigma_px.values[begin + i] = valid ? sigma : static_cast<float>(nan);
    map.valid.values[begin + i] = valid;
    map.confidence.values[begin + i] = contrast > 0 ? std::min(weakest / contrast, 1.0f) : 0.0f;
  }
}

template <class T>
DecodedMap decode(const ImageStack<T>& stack, const GraySequence& sequence, const Limits& limits) {
  DecodedMap map(stack.width, stack.height);
  const std::size_t pixels = stack.picture_size();
  parallel_for((pixels + segment_pixels - 1) / segment_pixels, [&](std::size_t s) {
    const std::size_t begin = s * segment_pixels, count = std::min(segment_pixels, pixels - begin);
    judge(read_codes(stack, sequence, begin, count), stack.picture(stack.count - 2).data() + begin,
          stack.picture(stack.count - 1).data() + begin, sequence, limits, begin, map);
  });
  return map;
}

template <class T>
double noise_dn(const ImageStack<T>& stack, double min_white_minus_black) {
  const std::span<const T> white = stack.picture(stack.count - 2), black = stack.picture(stack.count - 1);
  const std::size_t step =
      std::max<std::size_t>(1, stack.picture_size() / 4096) | 1;  // odd: meets all columns
  std::vector<int> rests;
  for (std::size_t i = 0; i < white.size(); i += step) {
    if (!(white[i] - black[i] > min_white_minus_black)) continue;
    for (int k = 0; k + 3 < stack.count; k += 2)
      rests.push_back(std::abs(stack.picture(k)[i] + stack.picture(k + 1)[i] - white[i] - black[i]));
  }
  if (rests.empty()) return 0;
  std::nth_element(rests.begin(), rests.begin() + rests.size() / 2, rests.end());
  return 1.4826 * rests[rests.size() / 2] / 2;
}

/// How many of the stack's DN are one DN of 8 bits.
double dn_per_8bit_dn(const ImageStack<std::uint8_t>&) { return 1; }
double dn_per_8bit_dn(const ImageStack<std::uint16_t>& stack) {
  const std::span<const std::uint16_t> white = stack.picture(stack.count - 2);
  const int bits =
      std::max(8, static_cast<int>(std::bit_width(*std::max_element(white.begin(), white.end()))));
  return ((1 << bits) - 1) / 255.0;
}

template <class T>
Limits limits_of(const ImageStack<T>& stack, const GrayDecodeOptions& options) {
  const double unit = dn_per_8bit_dn(stack), white_minus_black = unit * options.min_white_minus_black_dn;
  const double noise = options.min_pair_sigmas > 0 ? noise_dn(stack, white_minus_black) : 0;
  const double pair =
      std::max(unit * options.min_pair_difference_dn, options.min_pair_sigmas * std::numbers::sqrt2 * noise);
  return {float(white_minus_black), float(pair), float(options.min_pair_fraction)};
}

template <class T>
void validate(const ImageStack<T>& stack, const GraySequence& sequence, const GrayDecodeOptions& options) {
  const int expected = picture_count(sequence);
  if (stack.count != expected) {
    throw InputError(fmt::format("Gray code: {} pictures, expected {} for a projector of {}×{}", stack.count,
                                 expected, sequence.projector_size.x, sequence.projector_size.y));
  }
  if (stack.picture_size() == 0) throw InputError("Gray code: the pictures are empty, expected pixels");
  for (const double threshold : {options.min_white_minus_black_dn, options.min_pair_difference_dn,
                                 options.min_pair_fraction, options.min_pair_sigmas}) {
    if (!std::isfinite(threshold))
      throw InputError(fmt::format("Gray code: a threshold of {}, expected a finite number", threshold));
  }
}

}  // namespace

DecodedMap decode_gray(const CapturedStack& pictures, glm::ivec2 projector_size,
                       const GrayDecodeOptions& options) {
  const GraySequence sequence{projector_size};
  validate(sequence);
  return std::visit(
      [&](const auto& stack) {
        validate(stack, sequence, options);
        return decode(stack, sequence, limits_of(stack, options));
      },
      pictures);
}

double picture_noise_dn(const CapturedStack& pictures, double min_white_minus_black) {
  return std::visit(
      [&](const auto& stack) {
        if (stack.count < 2) throw InputError("Gray code: fewer than two pictures, expected white and black");
        return noise_dn(stack, min_white_minus_black);
      },
      pictures);
}

}  // namespace laterna
