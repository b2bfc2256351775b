#include "sim/pattern_sequence.h"

#include "sim/error.h"
#include "sim/parallel.h"
#include "sim/pattern_board.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace laterna {

namespace {

using Group = PatternGroup;
using Values = std::vector<std::uint8_t>;

constexpr int most_pictures = 512;
constexpr const char* axis_names[] = {"column", "row"};

bool is_board(PatternKind kind) { return kind == PatternKind::chessboard || kind == PatternKind::charuco; }
bool has_pairs(PatternKind kind) {
  return kind == PatternKind::gray || kind == PatternKind::xor_gray || kind == PatternKind::gray_phase;
}
bool has_fringes(PatternKind kind) {
  return is_coded(kind) && (!has_pairs(kind) || kind == PatternKind::gray_phase);
}

void expect(bool condition, const std::string& found, const std::string& expected) {
  if (!condition) throw InputError(fmt::format("patterns: {}, expected {}", found, expected));
}

void validate_fringes(const PatternParameters& p) {
  expect(p.steps >= 3 && p.steps <= 64, fmt::format("steps is {}", p.steps), "3 to 64");
  std::vector<double> pitches = p.pitches_px;
  const bool takes_list = p.kind == PatternKind::multi_frequency || p.kind == PatternKind::micro_phase;
  expect(takes_list || pitches.empty(), "pitches_px is given",
         "it with multi_frequency and micro_phase only");
  const std::size_t fewest = p.kind == PatternKind::micro_phase ? 3 : 2;
  expect(pitches.empty() || (pitches.size() >= fewest && pitches.size() <= 16),
         fmt::format("pitches_px has {} numbers", pitches.size()), fmt::format("{} to 16", fewest));
  pitches.push_back(p.pitch_px);
  for (const double pitch : pitches)
    expect(pitch >= 2 && pitch <= 1e5, fmt::format("a pitch of {} px", pitch), "2 to 100000");
}

/// A repeat inside the projector: no decoder can tell the two places apart.
void validate_distance(const PatternParameters& p, int size_px) {
  const double distance = least_fringe_distance(p, size_px);
  expect(distance >= 0.1, fmt::format("the pitches repeat within {} px (distance {:.3f})", size_px, distance),
         "pitches that tell all places apart (distance at least 0.1)");
}

void validate_board(const PatternSequence& sequence) {
  const int square = sequence.parameters.square_px;
  expect(square >= 8 && square <= 4096, fmt::format("square_px is {}", square), "8 to 4096");
  const glm::ivec2 squares = board_layout(sequence).squares;
  expect(std::min(squares.x, squares.y) >= 3, fmt::format("a board of {}×{} squares", squares.x, squares.y),
         "at least 3×3: a smaller square_px");
  expect(sequence.parameters.kind != PatternKind::charuco || squares.x * squares.y / 2 <= 1000,
         fmt::format("a board of {}×{} squares", squares.x, squares.y),
         "at most 1000 markers: a larger square_px");
}

void append_groups(const PatternSequence& sequence, int axis, std::vector<Group>& groups) {
  const PatternParameters& p = sequence.parameters;
  int next = groups.empty() ? 0 : groups.back().first + groups.back().count;
  const auto add = [&](Group group) {
    group.axis = axis, group.first = next, next += group.count;
    groups.push_back(group);
  };
  if (has_pairs(p.kind)) {
    for (int bit = word_code(sequence, axis).bits - 1; bit >= 0; --bit)
      add({Group::Kind::pair, 0, 0, 2, bit, 0});
  }
  if (!has_fringes(p.kind)) return;
  bool first = true;
  for (const double pitch : fringe_pitches_px(p, sequence.projector_size[axis])) {
    add({Group::Kind::fringe, 0, 0, first || p.kind != PatternKind::micro_phase ? p.steps : 1, 0, pitch});
    first = false;
  }
}

std::uint8_t value_of(bool lit) { return lit ? 255 : 0; }

/// round(127.5·(1 + cos 2π·turns)), halves up although cosines are inexact: values at ±turns are equal, so
/// rounding shifts no phase on average.
std::uint8_t sinusoid_value(double turns) {
  return std::uint8_t(
      std::min(255L, std::lround(127.5 * (1 + std::cos(2 * std::numbers::pi * turns)) + 1e-9)));
}

/// What picture `group.first + j` shows along its axis.
Values profile(const PatternSequence& sequence, const Group& group, int j) {
  Values values;
  for (int x = 0; x < sequence.projector_size[group.axis]; ++x) {
    if (group.kind == Group::Kind::pair) {
      values.push_back(value_of((code_word(sequence, group.axis, x) >> group.bit & 1u) != unsigned(j)));
    } else {
      const double turns = x / group.pitch_px + double(j) / group.count;
      values.push_back(sinusoid_value(turns));
    }
  }
  return values;
}

/// One picture of a coded sequence: `values` along `axis`.
struct Line {
  int axis = 0;
  Values values;
};

std::vector<Line> lines_of(const PatternSequence& sequence) {
  std::vector<Line> lines;
  for (const Group& group : pattern_groups(sequence))
    for (int j = 0; j < group.count; ++j) lines.push_back({group.axis, profile(sequence, group, j)});
  for (const int value : {255, 0})
    lines.push_back({0, Values(sequence.projector_size.x, std::uint8_t(value))});
  if (sequence.parameters.repeat_first) lines.push_back(lines.front());
  return lines;
}

PatternStack board_stack(const PatternSequence& sequence) {
  const Image<std::uint8_t> board = board_picture(sequence);
  PatternStack stack{board.width, board.height, 3, {}, linear_light(), {}};
  for (const std::uint8_t value : board.values) stack.values.insert(stack.values.end(), {value, 255, 0});
  return stack;
}

void check_picture(const PatternSequence& sequence, int k) {
  const int count = picture_count(sequence);
  expect(k >= 0 && k < count, fmt::format("picture {}", k), fmt::format("0 to {}", count - 1));
}

/// The group of picture k; null for white and black.
const Group* group_of(const std::vector<Group>& groups, int k) {
  for (const Group& group : groups)
    if (k >= group.first && k < group.first + group.count) return &group;
  return nullptr;
}

}  // namespace

bool comes_from_files(PatternKind kind) {
  return kind == PatternKind::slide || kind == PatternKind::pictures;
}

bool is_coded(PatternKind kind) { return !is_board(kind) && !comes_from_files(kind); }

void validate(const PatternSequence& sequence) {
  validate(GraySequence{sequence.projector_size});
  const PatternParameters& p = sequence.parameters;
  expect(!p.repeat_first || is_coded(p.kind), "repeat_first is given", "it with coded families only");
  if (comes_from_files(p.kind)) return;
  if (is_board(p.kind)) return validate_board(sequence);
  if (p.kind == PatternKind::xor_gray) {
    expect(p.xor_stripe_px >= 2 && p.xor_stripe_px <= 1024 && std::has_single_bit(unsigned(p.xor_stripe_px)),
           fmt::format("xor_stripe_px is {}", p.xor_stripe_px), "a power of two from 2 to 1024");
  }
  if (has_fringes(p.kind)) {
    validate_fringes(p);
    for (int axis = 0; axis < 2 && p.kind != PatternKind::gray_phase; ++axis)
      validate_distance(p, sequence.projector_size[axis]);
  }
  const int count = picture_count(sequence);
  expect(count <= most_pictures, fmt::format("{} pictures", count), fmt::format("at most {}", most_pictures));
  const std::vector<Group> groups = pattern_groups(sequence);
  expect(!p.repeat_first || (!groups.empty() && groups[0].axis == 0), "repeat_first without columns to tell",
         "a projector at least 2 px wide");
}

std::vector<Group> pattern_groups(const PatternSequence& sequence) {
  std::vector<Group> groups;
  if (!is_coded(sequence.parameters.kind)) return groups;
  for (int axis = 0; axis < 2; ++axis) append_groups(sequence, axis, groups);
  return groups;
}

int picture_count(const PatternSequence& sequence) {
  const PatternKind kind = sequence.parameters.kind;
  expect(!comes_from_files(kind), "pictures from files", "a family that is drawn");
  if (is_board(kind)) return 3;
  const std::vector<Group> groups = pattern_groups(sequence);
  return (groups.empty() ? 0 : groups.back().first + groups.back().count) + 2 +
         sequence.parameters.repeat_first;
}

int white_picture(const PatternSequence& sequence) {
  return picture_count(sequence) - 2 - sequence.parameters.repeat_first;
}

std::string picture_name(const PatternSequence& sequence, int k) {
  check_picture(sequence, k);
  const int white = white_picture(sequence);
  if (k >= white + 2) return picture_name(sequence, 0) + " again";
  if (k >= white) return k == white ? "white" : "black";
  if (is_board(sequence.parameters.kind)) return "board";
  const std::vector<Group> groups = pattern_groups(sequence);
  const Group& group = *group_of(groups, k);
  if (group.kind == Group::Kind::pair)
    return fmt::format("{} bit {}{}", axis_names[group.axis], group.bit, k > group.first ? " inverse" : "");
  return fmt::format("{} fringe of {:.6g} px, step {}", axis_names[group.axis], group.pitch_px,
                     k - group.first + 1);
}

Image<std::uint8_t> pattern_picture(const PatternSequence& sequence, int k) {
  validate(sequence);
  check_picture(sequence, k);
  const int white = white_picture(sequence);
  const glm::ivec2 size = sequence.projector_size;
  if (k >= white + 2) return pattern_picture(sequence, 0);
  if (k >= white) return {size.x, size.y, value_of(k == white)};
  if (is_board(sequence.parameters.kind)) return board_picture(sequence);
  const std::vector<Group> groups = pattern_groups(sequence);
  const Group& group = *group_of(groups, k);
  const Values values = profile(sequence, group, k - group.first);
  Image<std::uint8_t> image(size.x, size.y);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) image(x, y) = values[group.axis == 0 ? x : y];
  return image;
}

PatternStack make_pattern_stack(const PatternSequence& sequence) {
  validate(sequence);
  expect(!comes_from_files(sequence.parameters.kind), "pictures from files", "a family that is drawn");
  if (is_board(sequence.parameters.kind)) return board_stack(sequence);
  const std::vector<Line> lines = lines_of(sequence);
  const glm::ivec2 size = sequence.projector_size;
  const std::size_t count = lines.size();
  // Columns come first, then rows: a row of texels is the first one with other values of the row pictures.
  const auto is_row = [](const Line& line) { return line.axis == 1; };
  const std::size_t rows_begin = std::find_if(lines.begin(), lines.end(), is_row) - lines.begin();
  const std::size_t rows = std::count_if(lines.begin(), lines.end(), is_row);
  Values first;
  for (int x = 0; x < size.x; ++x)
    for (const Line& line : lines) first.push_back(line.values[line.axis == 0 ? x : 0]);
  PatternStack stack{size.x, size.y, int(count), {}, linear_light(), {}};
  stack.values.resize(first.size() * size.y);
  parallel_for(std::size_t(size.y), [&](std::size_t y) {
    std::uint8_t* texel = stack.values.data() + y * first.size();
    std::copy(first.begin(), first.end(), texel);
    Values own;
    for (std::size_t k = 0; k < rows; ++k) own.push_back(lines[rows_begin + k].values[y]);
    for (int x = 0; x < size.x; ++x, texel += count) std::copy(own.begin(), own.end(), texel + rows_begin);
  });
  return stack;
}

bool is_binary(const PatternSequence& sequence) {
  const PatternKind kind = sequence.parameters.kind;
  return (kind == PatternKind::gray || kind == PatternKind::xor_gray) && picture_count(sequence) <= 64;
}

BinaryPatternStack make_binary_pattern_stack(const PatternSequence& sequence) {
  validate(sequence);
  expect(is_binary(sequence), "shades of grey, or more than 64 pictures", "a Gray or XOR code");
  const glm::ivec2 size = sequence.projector_size;
  const std::vector<Line> lines = lines_of(sequence);
  BinaryPatternStack stack{size.x, size.y, int(lines.size()), {}, {}};
  stack.column_codes.resize(size.x);
  stack.row_codes.resize(size.y);
  for (int k = 0; k < stack.count; ++k) {
    std::vector<std::uint64_t>& codes = lines[k].axis == 0 ? stack.column_codes : stack.row_codes;
    for (std::size_t x = 0; x < codes.size(); ++x) codes[x] |= lines[k].values[x] ? std::uint64_t{1} << k : 0;
  }
  return stack;
}

}  // namespace laterna
