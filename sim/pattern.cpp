#include "sim/pattern.h"

#include "sim/error.h"
#include "sim/parallel.h"

#include <fmt/format.h>

#include <algorithm>

namespace laterna {

namespace {

constexpr int largest_size = 16384;

using Kind = GrayPicture::Kind;

bool is_lit(const GrayPicture& picture, int x, int y) {
  if (picture.kind == Kind::white || picture.kind == Kind::black) return picture.kind == Kind::white;
  const int coordinate = picture.kind == Kind::column ? x : y;
  const bool bit = (gray_from_binary(static_cast<std::uint32_t>(coordinate)) >> picture.bit) & 1u;
  return bit != picture.inverse;
}

std::uint8_t value_of(bool lit) { return lit ? 255 : 0; }

std::vector<GrayPicture> all_pictures(const GraySequence& sequence) {
  std::vector<GrayPicture> pictures;
  for (int k = 0; k < picture_count(sequence); ++k) pictures.push_back(gray_picture(sequence, k));
  return pictures;
}

/// The first row with all texels: columns are right for every row, the row bits are those of row 0.
std::vector<std::uint8_t> first_row(const GraySequence& sequence, const std::vector<GrayPicture>& pictures) {
  std::vector<std::uint8_t> row;
  row.reserve(std::size_t(sequence.projector_size.x) * pictures.size());
  for (int x = 0; x < sequence.projector_size.x; ++x)
    for (const GrayPicture& picture : pictures) row.push_back(value_of(is_lit(picture, x, 0)));
  return row;
}

}  // namespace

void validate(const GraySequence& sequence) {
  const glm::ivec2 size = sequence.projector_size;
  if (std::min(size.x, size.y) >= 1 && std::max(size.x, size.y) <= largest_size) return;
  throw InputError(fmt::format("Gray code: a projector of {}×{} pixels, expected 1 to {} each way", size.x,
                               size.y, largest_size));
}

GrayPicture gray_picture(const GraySequence& sequence, int k) {
  validate(sequence);
  const int columns = 2 * column_bits(sequence), rows = 2 * row_bits(sequence), count = columns + rows + 2;
  if (k < 0 || k >= count)
    throw InputError(fmt::format("Gray code: picture {}, expected 0 to {}", k, count - 1));
  if (k < columns) return {Kind::column, column_bits(sequence) - 1 - k / 2, k % 2 == 1};
  if (k < columns + rows) return {Kind::row, row_bits(sequence) - 1 - (k - columns) / 2, k % 2 == 1};
  return {k == count - 2 ? Kind::white : Kind::black, 0, false};
}

std::string picture_name(const GraySequence& sequence, int k) {
  const GrayPicture picture = gray_picture(sequence, k);
  if (picture.kind == Kind::white) return "white";
  if (picture.kind == Kind::black) return "black";
  return fmt::format("{} bit {}{}", picture.kind == Kind::column ? "column" : "row", picture.bit,
                     picture.inverse ? " inverse" : "");
}

bool gray_bit(const GraySequence& sequence, int k, int x, int y) {
  return is_lit(gray_picture(sequence, k), x, y);
}

Image<std::uint8_t> pattern_picture(const GraySequence& sequence, int k) {
  const GrayPicture picture = gray_picture(sequence, k);
  Image<std::uint8_t> image(sequence.projector_size.x, sequence.projector_size.y);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) image(x, y) = value_of(is_lit(picture, x, y));
  return image;
}

PatternStack make_pattern_stack(const GraySequence& sequence) {
  validate(sequence);
  const std::vector<GrayPicture> pictures = all_pictures(sequence);
  const std::vector<std::uint8_t> row = first_row(sequence, pictures);
  PatternStack stack{
      sequence.projector_size.x, sequence.projector_size.y, int(pictures.size()), {}, linear_light(), {}};
  stack.values.resize(row.size() * stack.height);
  const int rows_begin = 2 * column_bits(sequence), rows_end = stack.count - 2;
  parallel_for(stack.height, [&](std::size_t y) {
    std::uint8_t* texel = stack.values.data() + y * row.size();
    std::copy(row.begin(), row.end(), texel);
    std::vector<std::uint8_t> bits;
    for (int k = rows_begin; k < rows_end; ++k) bits.push_back(value_of(is_lit(pictures[k], 0, int(y))));
    for (int x = 0; x < stack.width; ++x, texel += stack.count)
      std::copy(bits.begin(), bits.end(), texel + rows_begin);
  });
  return stack;
}

BinaryPatternStack make_binary_pattern_stack(const GraySequence& sequence) {
  validate(sequence);
  const glm::ivec2 size = sequence.projector_size;
  BinaryPatternStack stack{size.x, size.y, picture_count(sequence), {}, {}};
  stack.column_codes.resize(size.x);
  stack.row_codes.resize(size.y);
  for (int k = 0; k < stack.count; ++k) {
    const GrayPicture picture = gray_picture(sequence, k);
    const std::uint64_t bit = std::uint64_t{1} << k;
    if (picture.kind == Kind::row) {
      for (int y = 0; y < size.y; ++y) stack.row_codes[y] |= is_lit(picture, 0, y) ? bit : 0;
    } else {
      for (int x = 0; x < size.x; ++x) stack.column_codes[x] |= is_lit(picture, x, 0) ? bit : 0;
    }
  }
  return stack;
}

}  // namespace laterna
