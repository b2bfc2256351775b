#include "calib/decode.h"

#include "calib/decode_board.h"
#include "calib/repeat_check.h"
#include "sim/error.h"
#include "sim/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

bool is_far(const DecodedMap& map, std::size_t a, std::size_t b, double step_px) {
  return std::abs(map.u_px.values[a] - map.u_px.values[b]) > step_px ||
         std::abs(map.v_px.values[a] - map.v_px.values[b]) > step_px;
}

bool is_steep(const DecodedMap& map, int x, int y, double step_px) {
  const std::size_t here = std::size_t(y) * map.width + x;
  int neighbours = 0;
  for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, map.height - 1); ++ny) {
    for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, map.width - 1); ++nx) {
      const std::size_t other = std::size_t(ny) * map.width + nx;
      if (other == here || !map.valid.values[other]) continue;
      if (!is_far(map, here, other, step_px)) return false;
      ++neighbours;
    }
  }
  return neighbours >= 2;
}

double default_step_px(const PatternSequence& sequence) {
  const PatternKind kind = sequence.parameters.kind;
  if (!is_coded(kind) || kind == PatternKind::gray || kind == PatternKind::xor_gray) return 0;
  return fringe_pitches_px(sequence.parameters, sequence.projector_size.x)[0] / 2;
}

DecodedMap decode_family(const CapturedView& pictures, const PatternSequence& sequence,
                         const DecodeOptions& options) {
  switch (sequence.parameters.kind) {
    case PatternKind::gray:
    case PatternKind::xor_gray:
      return decode_gray(pictures, sequence, options.gray);
    case PatternKind::chessboard:
    case PatternKind::charuco:
      return decode_board(pictures, sequence);
    case PatternKind::slide:
    case PatternKind::pictures:
      throw InputError(
          "patterns: pictures from files tell no pixel its place, expected a coded family or a board");
    default:
      return decode_phase(pictures, sequence, options.phase);
  }
}

}  // namespace

void reject_steep(DecodedMap& map, double max_neighbour_step_px) {
  std::vector<std::uint8_t> steep(map.valid.values.size(), 0);
  parallel_for(std::size_t(map.height), [&](std::size_t y) {
    for (int x = 0; x < map.width; ++x) {
      const std::size_t i = y * map.width + x;
      steep[i] = map.valid.values[i] && is_steep(map, x, int(y), max_neighbour_step_px);
    }
  });
  for (std::size_t i = 0; i < steep.size(); ++i)
    if (steep[i]) reject(map, i, Reject::steep);
}

DecodedMap decode(const CapturedView& pictures, const PatternSequence& sequence,
                  const DecodeOptions& options) {
  if (options.max_neighbour_step_px && !(*options.max_neighbour_step_px >= 0))
    throw InputError(fmt::format("decode: a neighbours' step of {} px, expected at least 0",
                                 *options.max_neighbour_step_px));
  if (sequence.parameters.repeat_first)
    return decode(without_repeat(pictures, sequence), without_repeat(sequence), options);
  DecodedMap map = decode_family(pictures, sequence, options);
  const double step = options.max_neighbour_step_px.value_or(default_step_px(sequence));
  if (step > 0) reject_steep(map, step);
  return map;
}

}  // namespace laterna
