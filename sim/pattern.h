// Gray-code patterns: the pictures that a projector shows so that each of its pixels tells its own place.
//
// The order is that of OpenCV's structured_light: the bits of the column, most significant first, each as
// pattern and then inverse; the bits of the row likewise; all white; all black. Column code 0 is the left
// column, row code 0 the top row. A size of n has ceil(log2 n) bits, so one of 1 has none.
#pragma once

#include "sim/image.h"

#include <glm/glm.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace laterna {

/// A Gray-code sequence is told by the projector's size alone: 1 to 16384 pixels each way.
struct GraySequence {
  glm::ivec2 projector_size{0, 0};
};

/// Throws InputError where the size is outside 1..16384.
void validate(const GraySequence& sequence);

/// How many bits tell `size` columns or rows apart: ceil(log2 size), 0 for a size of 1.
inline int gray_bits(int size) { return std::bit_width(static_cast<std::uint32_t>(size - 1)); }
inline int column_bits(const GraySequence& sequence) { return gray_bits(sequence.projector_size.x); }
inline int row_bits(const GraySequence& sequence) { return gray_bits(sequence.projector_size.y); }

/// How many pictures the sequence has: 2·column_bits + 2·row_bits + 2.
inline int picture_count(const GraySequence& sequence) {
  return 2 * column_bits(sequence) + 2 * row_bits(sequence) + 2;
}

/// The reflected binary code, in which neighbours differ in one bit: binary ^ (binary >> 1).
constexpr std::uint32_t gray_from_binary(std::uint32_t binary) { return binary ^ (binary >> 1); }

/// The inverse of gray_from_binary: bit k of the result is the exclusive or of all bits ≥ k of the code.
constexpr std::uint32_t binary_from_gray(std::uint32_t gray) {
  for (int shift = 1; shift < 32; shift *= 2) gray ^= gray >> shift;
  return gray;
}

/// What picture k of a sequence shows.
struct GrayPicture {
  enum class Kind { column, row, white, black } kind = Kind::black;
  int bit = 0;           ///< 0: the least significant; of columns and rows only
  bool inverse = false;  ///< of columns and rows only
};

/// Throws InputError where k is not in [0, picture_count).
GrayPicture gray_picture(const GraySequence& sequence, int k);

/// For people: "column bit 9", "row bit 0 inverse", "white", "black".
std::string picture_name(const GraySequence& sequence, int k);

/// Whether picture k is lit at projector pixel (x, y).
bool gray_bit(const GraySequence& sequence, int k, int x, int y);

/// Picture k: 0 or 255 per projector pixel.
Image<std::uint8_t> pattern_picture(const GraySequence& sequence, int k);

/// v/255 for v from 0 to 255.
constexpr std::array<float, 256> linear_light() {
  std::array<float, 256> light{};
  for (int v = 0; v < 256; ++v) light[v] = float(v) / 255;
  return light;
}

/// All pictures of a sequence with the values of one texel side by side, so that one fetch serves every
/// picture: picture k at (x, y) is values[(y·width + x)·count + k]. Its light, as a share of the
/// all-white picture's, is light_of_value[that] + added_light[k].
struct PatternStack {
  int width = 0, height = 0, count = 0;
  std::vector<std::uint8_t> values;
  std::array<float, 256> light_of_value = linear_light();
  std::vector<float> added_light{};  ///< one per picture, or empty: none

  /// Whether light is value/255, as it is unless a pattern effect is on.
  bool is_linear() const { return added_light.empty() && light_of_value == linear_light(); }
  const std::uint8_t* texel(int x, int y) const {
    return values.data() + (std::size_t(y) * width + x) * count;
  }
};

/// The whole sequence, 0 or 255 per value: equal to pattern_picture for each k.
PatternStack make_pattern_stack(const GraySequence& sequence);

/// Up to 64 pictures of black and white that are unions of columns and rows, as those of a Gray sequence are:
/// bit k of `code(x, y)` says whether picture k is lit at (x, y).
struct BinaryPatternStack {
  int width = 0, height = 0, count = 0;
  std::vector<std::uint64_t> column_codes, row_codes;  ///< one per column; one per row

  std::uint64_t code(int x, int y) const { return column_codes[x] | row_codes[y]; }
};

/// The whole sequence as bits: equal to gray_bit for each k. (16384×16384 pixels need 58.)
BinaryPatternStack make_binary_pattern_stack(const GraySequence& sequence);

}  // namespace laterna
