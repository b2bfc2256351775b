#include "calib/decode_gray.h"

#include "calib/gray_crossing.h"
#include "calib/pair_codes.h"
#include "calib/pair_kernel.h"
#include "calib/sum_check.h"
#include "sim/error.h"
#include "sim/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace laterna {

namespace {

/// Pixels are decoded in segments of this many: a page of each 8-bit picture.
constexpr std::size_t segment_pixels = 4096;

/// The thresholds in the stack's own DN.
struct Limits {
  float white_minus_black, pair_difference, pair_fraction;
};

template <class T>
struct GrayPictures {
  ImageStackView<T> stack;
  PairPictures<T> columns, rows;
  Limits limits;

  GrayPictures(const ImageStackView<T>& pictures, const PatternSequence& sequence, const Limits& thresholds)
      : stack(pictures), columns(pictures, sequence, 0), rows(pictures, sequence, 1), limits(thresholds) {}
};

/// A run of pixels, and white and black there.
template <class T>
struct Segment {
  std::size_t begin, count;
  std::vector<T> weakest;  ///< of all pairs, once read() has been called
  const T *white, *black;

  Segment(const GrayPictures<T>& pictures, std::size_t index)
      : begin(index * segment_pixels),
        count(std::min(segment_pixels, pictures.stack.picture_size() - begin)),
        weakest(count, std::numeric_limits<T>::max()),
        white(pictures.stack.picture(pictures.stack.count - 2).data() + begin),
        black(pictures.stack.picture(pictures.stack.count - 1).data() + begin) {}
  void read(const GrayPictures<T>& pictures, std::uint16_t* column, std::uint16_t* row) {
    pictures.columns.read(begin, count, column, weakest.data());
    pictures.rows.read(begin, count, row, weakest.data());
  }
  float contrast(std::size_t i) const { return static_cast<float>(white[i] - black[i]); }
};

/// Calls body(segment) for all pixels.
template <class T, class Body>
void for_segments(const GrayPictures<T>& pictures, const Body& body) {
  parallel_for((pictures.stack.picture_size() + segment_pixels - 1) / segment_pixels, [&](std::size_t index) {
    Segment<T> segment(pictures, index);
    body(segment);
  });
}

bool is_lit(float contrast, const Limits& limits) { return contrast > limits.white_minus_black; }
bool is_distinct(float weakest, float contrast, const Limits& limits) {
  return (weakest >= limits.pair_difference) & (weakest >= limits.pair_fraction * contrast);
}

template <class T>
DecodedMap decode(const GrayPictures<T>& pictures) {
  DecodedMap map(pictures.stack.width, pictures.stack.height);
  const float sigma = static_cast<float>(1 / std::sqrt(12.0));
  for_segments(pictures, [&](Segment<T>& segment) {
    std::array<std::uint16_t, segment_pixels> columns, rows;
    segment.read(pictures, columns.data(), rows.data());
    for (std::size_t i = 0; i < segment.count; ++i) {
      const std::size_t pixel = segment.begin + i;
      const int column = columns[i], row = rows[i];
      const float contrast = segment.contrast(i), weakest = segment.weakest[i];
      map.confidence.values[pixel] = contrast > 0 ? std::min(weakest / contrast, 1.0f) : 0.0f;
      const bool inside = column < pictures.columns.code.stripes && row < pictures.rows.code.stripes;
      if (!is_lit(contrast, pictures.limits)) {
        reject(map, pixel, Reject::dim);
      } else if (!is_distinct(weakest, contrast, pictures.limits)) {
        reject(map, pixel, Reject::pair);
      } else if (!inside) {
        reject(map, pixel, Reject::outside);
      } else {
        map.u_px.values[pixel] = column, map.v_px.values[pixel] = row;
        map.sigma_px.values[pixel] = sigma, map.valid.values[pixel] = 1;
      }
    }
  });
  return map;
}

template <class T>
void decode_codes(const GrayPictures<T>& pictures, GrayCodes& codes) {
  const PairLimits limits{pictures.limits.white_minus_black, pictures.limits.pair_difference,
                          pictures.limits.pair_fraction, pictures.columns.code.stripes,
                          pictures.rows.code.stripes};
  for_segments(pictures, [&](Segment<T>& segment) {
    std::uint16_t *column = codes.column.values.data() + segment.begin,
                  *row = codes.row.values.data() + segment.begin;
    segment.read(pictures, column, row);
    judge_pairs(segment.white, segment.black, segment.weakest.data(), column, row, limits, segment.count,
                codes.valid.values.data() + segment.begin);
  });
}

Limits limits_of(const CapturedView& pictures, const PatternSequence& sequence,
                 const GrayDecodeOptions& options) {
  const double unit = full_scale_dn(pictures) / 255.0;
  const double white_minus_black = unit * options.min_white_minus_black_dn;
  const double noise =
      options.min_pair_sigmas > 0 ? sum_noise_dn(pictures, pattern_groups(sequence), white_minus_black) : 0;
  const double pair =
      std::max(unit * options.min_pair_difference_dn, options.min_pair_sigmas * std::numbers::sqrt2 * noise);
  return {float(white_minus_black), float(pair), float(options.min_pair_fraction)};
}

template <class T>
void validate(const ImageStackView<T>& stack, const PatternSequence& sequence,
              const GrayDecodeOptions& options) {
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

/// Checks everything and calls body(GrayPictures).
template <class Body>
auto with_pictures(const CapturedView& pictures, const PatternSequence& sequence,
                   const GrayDecodeOptions& options, const Body& body) {
  validate(sequence);
  const PatternKind kind = sequence.parameters.kind;
  if (kind != PatternKind::gray && kind != PatternKind::xor_gray)
    throw InputError("Gray code: the patterns are of another family, expected gray or xor_gray");
  if (sequence.parameters.repeat_first)
    throw InputError("Gray code: the first picture is repeated, expected without_repeat()");
  return std::visit(
      [&](const auto& stack) {
        validate(stack, sequence, options);
        return body(GrayPictures(stack, sequence, limits_of(pictures, sequence, options)));
      },
      pictures);
}

template <class Value>
void fit_size(Image<Value>& image, int width, int height) {
  if (image.width != width || image.height != height) image = Image<Value>(width, height);
}

}  // namespace

DecodedMap decode_gray(const CapturedView& pictures, const PatternSequence& sequence,
                       const GrayDecodeOptions& options) {
  DecodedMap map = with_pictures(pictures, sequence, options, [](const auto& gray) { return decode(gray); });
  if (options.subpixel) refine_at_crossings(pictures, sequence, map);
  return map;
}

DecodedMap decode_gray(const CapturedView& pictures, glm::ivec2 projector_size,
                       const GrayDecodeOptions& options) {
  return decode_gray(pictures, PatternSequence{{}, projector_size}, options);
}

void decode_gray_codes(const CapturedView& pictures, const PatternSequence& sequence,
                       const GrayDecodeOptions& options, GrayCodes& codes) {
  with_pictures(pictures, sequence, options, [&](const auto& gray) {
    fit_size(codes.column, gray.stack.width, gray.stack.height);
    fit_size(codes.row, gray.stack.width, gray.stack.height);
    fit_size(codes.valid, gray.stack.width, gray.stack.height);
    decode_codes(gray, codes);
  });
}

double picture_noise_dn(const CapturedView& pictures, double min_white_minus_black) {
  const int count = std::visit([](const auto& stack) { return stack.count; }, pictures);
  if (count < 2) throw InputError("Gray code: fewer than two pictures, expected white and black");
  std::vector<PatternGroup> pairs;
  for (int k = 0; k + 3 < count; k += 2) pairs.push_back({PatternGroup::Kind::pair, 0, k, 2, 0, 0});
  return sum_noise_dn(pictures, pairs, min_white_minus_black);
}

}  // namespace laterna
