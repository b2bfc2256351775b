#include "calib/gray_crossing.h"

#include "calib/sum_check.h"
#include "sim/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace laterna {

namespace {

constexpr double farthest_px = 16;      // between two crossings
constexpr double edge_shape_px = 0.05;  // of a blurred edge, in camera pixels
constexpr double full_share = 0.9;      // of white - black: a sample off the edge
constexpr float whole_pixel_variance = 1 / 12.0f;

/// A line of camera pixels: pixel i of it is first + i·step.
struct Line {
  std::size_t first, step;
  int count;
  std::size_t at(int i) const { return first + std::size_t(i) * step; }
};

/// A place along a line, in camera pixels, where the projector coordinate is known.
struct Crossing {
  double position, place_px, variance;  ///< variance in camera pixels²
};

/// u or v, refined, with its variance in projector pixels².
struct Refined {
  std::vector<double> place_px;
  std::vector<float> variance;
};

template <class T>
struct Axis {
  ImageStackView<T> stack;
  std::vector<std::uint32_t> words;  ///< of each column or row
  std::vector<int> picture_of_bit;   ///< the pattern; its inverse follows
  double noise_dn;

  Axis(const ImageStackView<T>& pictures, const PatternSequence& sequence, int axis, double noise)
      : stack(pictures), picture_of_bit(32, 0), noise_dn(noise) {
    for (int x = 0; x < sequence.projector_size[axis]; ++x) words.push_back(code_word(sequence, axis, x));
    for (const PatternGroup& group : pattern_groups(sequence))
      if (group.axis == axis) picture_of_bit[group.bit] = group.first;
  }
  double difference(int picture, std::size_t i) const {
    return double(stack.picture(picture)[i]) - double(stack.picture(picture + 1)[i]);
  }
  double contrast(std::size_t i) const {
    return double(stack.picture(stack.count - 2)[i]) - double(stack.picture(stack.count - 1)[i]);
  }

  /// Between pixels i and i + gap of the line, which tell the neighbours `a` and `b`.
  Crossing crossing(const Line& line, int i, int gap, int a, int b) const {
    const int picture = picture_of_bit[std::countr_zero(words[a] ^ words[b])];
    const bool later =
        gap == 2 && (difference(picture, line.at(i)) > 0) == (difference(picture, line.at(i + 1)) > 0);
    i += later ? 1 : 0;
    const double before = difference(picture, line.at(i)), after = difference(picture, line.at(i + 1));
    const double share = before / (before - after);
    const bool full = std::abs(before) > full_share * contrast(line.at(i)) &&
                      std::abs(after) > full_share * contrast(line.at(i + 1));
    const double slope = std::abs(before - after), spread = share * share + (1 - share) * (1 - share);
    const double variance =
        full ? 1 / 12.0 : 2 * noise_dn * noise_dn * spread / (slope * slope) + edge_shape_px * edge_shape_px;
    return {i + share, 0.5 * (a + b), variance};
  }
};

/// Pixels between two crossings take the line between them where it is more certain than what they have.
void interpolate(const Line& line, const Crossing& a, const Crossing& b, Refined& refined) {
  const double length = b.position - a.position, rise = b.place_px - a.place_px;
  if (length <= 0 || length > farthest_px || std::abs(rise) != 1) return;
  for (int i = int(std::ceil(a.position)); i <= int(std::floor(b.position)); ++i) {
    const double share = (i - a.position) / length, rest = 1 - share;
    const auto variance = float((rest * rest * a.variance + share * share * b.variance) / (length * length));
    const std::size_t pixel = line.at(i);
    if (std::isnan(refined.place_px[pixel]) || !(variance < refined.variance[pixel])) continue;
    refined.variance[pixel] = variance;
    refined.place_px[pixel] = a.place_px + share * rise;
  }
}

template <class T>
void refine_line(const Axis<T>& axis, const Line& line, const DecodedMap& map,
                 const std::vector<double>& whole, Refined& refined) {
  bool has_last = false;
  Crossing last{};
  for (int i = 0; i + 1 < line.count; ++i) {
    if (!map.valid.values[line.at(i)]) continue;
    const int gap = map.valid.values[line.at(i + 1)] ? 1 : 2;
    const bool both = i + gap < line.count && map.valid.values[line.at(i + gap)];
    const int a = int(whole[line.at(i)]), b = both ? int(whole[line.at(i + gap)]) : a + 2;
    if (a == b) continue;
    if (std::abs(a - b) != 1) {
      has_last = false;
      continue;
    }
    const Crossing crossing = axis.crossing(line, i, gap, a, b);
    if (has_last) interpolate(line, last, crossing, refined);
    last = crossing, has_last = true;
  }
}

template <class T>
Refined refine_axis(const Axis<T>& axis, const DecodedMap& map, const std::vector<double>& whole) {
  Refined refined{whole, std::vector<float>(whole.size(), whole_pixel_variance)};
  const std::size_t width = map.width;
  parallel_for(std::size_t(map.height), [&](std::size_t y) {
    refine_line(axis, {y * width, 1, map.width}, map, whole, refined);
  });
  parallel_for(width, [&](std::size_t x) { refine_line(axis, {x, width, map.height}, map, whole, refined); });
  return refined;
}

}  // namespace

void refine_at_crossings(const CapturedView& pictures, const PatternSequence& sequence, DecodedMap& map) {
  const double noise = sum_noise_dn(pictures, pattern_groups(sequence), 0);
  std::visit(
      [&](const auto& stack) {
        Refined u = refine_axis(Axis(stack, sequence, 0, noise), map, map.u_px.values);
        Refined v = refine_axis(Axis(stack, sequence, 1, noise), map, map.v_px.values);
        for (std::size_t i = 0; i < map.valid.values.size(); ++i)
          if (map.valid.values[i]) map.sigma_px.values[i] = std::sqrt(0.5f * (u.variance[i] + v.variance[i]));
        map.u_px.values = std::move(u.place_px);
        map.v_px.values = std::move(v.place_px);
      },
      pictures);
}

}  // namespace laterna
