#include "calib/group_places.h"

#include "sim/parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace laterna {

namespace {

constexpr std::size_t most_pixels = 65536, least_pixels = 500;
constexpr double least_px = 0.1, least_sigmas = 6;

struct Pixels {
  std::vector<std::size_t> index;
  std::vector<double> place_px[2];  // by axis
};

Pixels chosen(const DecodedMap& map) {
  Pixels p;
  const std::size_t step =
      std::max<std::size_t>(1, map.valid.values.size() / most_pixels) | 1;  // odd: meets all columns
  for (std::size_t i = 0; i < map.valid.values.size(); i += step) {
    if (!map.valid.values[i]) continue;
    p.index.push_back(i);
    p.place_px[0].push_back(map.u_px.values[i]), p.place_px[1].push_back(map.v_px.values[i]);
  }
  return p;
}

std::optional<GroupPlace> mean_of(const PatternGroup& group, double n, double sum, double squares) {
  if (n < double(least_pixels)) return std::nullopt;
  const double mean = sum / n;
  return GroupPlace{group, mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n)};
}

template <class T>
std::optional<GroupPlace> place_of_fringe(const ImageStackView<T>& stack, const PatternGroup& group,
                                          const Pixels& pixels) {
  const std::vector<double>& place_px = pixels.place_px[group.axis];
  std::vector<glm::dvec2> step;  // of fringe_fit.h's least squares, for (c, s)
  for (int j = 0; j < group.count; ++j) {
    const double shift = 2 * std::numbers::pi * j / group.count;
    step.emplace_back(std::cos(shift), -std::sin(shift));
  }
  double sum = 0, squares = 0;
  for (std::size_t k = 0; k < place_px.size(); ++k) {
    glm::dvec2 cs(0.0);
    for (int j = 0; j < group.count; ++j)
      cs += double(stack.picture(group.first + j)[pixels.index[k]]) * step[std::size_t(j)];
    const double turns = std::atan2(cs.y, cs.x) / (2 * std::numbers::pi) - place_px[k] / group.pitch_px;
    const double off = group.pitch_px * (turns - std::round(turns));
    sum += off, squares += off * off;
  }
  return mean_of(group, double(place_px.size()), sum, squares);
}

template <class T>
std::optional<GroupPlace> place_of_pair(const ImageStackView<T>& stack, const PatternSequence& sequence,
                                        const PatternGroup& group, const Pixels& pixels) {
  const std::vector<double>& place_px = pixels.place_px[group.axis];
  const double within = word_code(sequence, group.axis).stripe_px / 4;
  const int last = sequence.projector_size[group.axis] - 1;
  const auto bit_at = [&](double place) {
    const int x = std::clamp(int(std::floor(place + 0.5)), 0, last);
    return (code_word(sequence, group.axis, x) >> group.bit & 1u) != 0;
  };
  double n = 0, sum = 0, squares = 0;
  for (std::size_t k = 0; k < place_px.size(); ++k) {
    const bool before = bit_at(place_px[k] - within), after = bit_at(place_px[k] + within);
    if (before == after) continue;
    const std::size_t i = pixels.index[k];
    const bool read = stack.picture(group.first)[i] > stack.picture(group.first + 1)[i];
    const double off = read == bit_at(place_px[k]) ? 0 : read == after ? 2 * within : -2 * within;
    ++n, sum += off, squares += off * off;
  }
  return mean_of(group, n, sum, squares);
}

bool has_places_of_its_own(const PatternSequence& sequence, const PatternGroup& group) {
  const PatternKind kind = sequence.parameters.kind;
  if (group.kind == PatternGroup::Kind::pair) return kind == PatternKind::gray_phase;
  return kind != PatternKind::micro_phase && group.count >= 3;
}

}  // namespace

std::vector<GroupPlace> group_places(const CapturedView& pictures, const PatternSequence& sequence,
                                     const DecodedMap& map) {
  const Pixels pixels = chosen(map);
  const std::vector<PatternGroup> groups = pattern_groups(sequence);
  std::vector<std::optional<GroupPlace>> found(groups.size());
  std::visit(
      [&](const auto& stack) {
        parallel_for(groups.size(), [&](std::size_t g) {
          if (!has_places_of_its_own(sequence, groups[g])) return;
          found[g] = groups[g].kind == PatternGroup::Kind::pair
                         ? place_of_pair(stack, sequence, groups[g], pixels)
                         : place_of_fringe(stack, groups[g], pixels);
        });
      },
      pictures);
  std::vector<GroupPlace> places;
  for (const auto& place : found)
    if (place) places.push_back(*place);
  return places;
}

std::optional<std::pair<GroupPlace, GroupPlace>> farthest_apart(const std::vector<GroupPlace>& places) {
  std::optional<std::pair<GroupPlace, GroupPlace>> worst;
  double most = 0;
  for (std::size_t a = 0; a < places.size(); ++a) {
    for (std::size_t b = a + 1; b < places.size(); ++b) {
      if (places[a].group.axis != places[b].group.axis) continue;
      const double apart = std::abs(places[a].mean_px - places[b].mean_px);
      const double sigma = std::hypot(places[a].sigma_px, places[b].sigma_px);
      if (apart <= std::max({least_px, least_sigmas * sigma, most})) continue;
      most = apart;
      worst = {places[a], places[b]};
    }
  }
  return worst;
}

}  // namespace laterna
