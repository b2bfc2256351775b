// Pictures of any pattern family to projector pixels.
#pragma once

#include "calib/decode_gray.h"
#include "calib/decode_phase.h"
#include "calib/decoded_map.h"
#include "sim/pattern_sequence.h"

#include <optional>

namespace laterna {

struct DecodeOptions {
  GrayDecodeOptions gray{};
  PhaseDecodeOptions phase{};
  /// A pixel is rejected as `steep` where at least two of its eight neighbours are valid and all differ from
  /// it by more, in u or in v. Absent: half the first pitch for families with fringes, off for the others.
  std::optional<double> max_neighbour_step_px{};
};

/// Decodes by family: decode_gray(), decode_phase() or decode_board(), then looks at the neighbours. A
/// repeated first picture is left out (report_on() compares it). Throws InputError as those do, and for a
/// slide or pictures from files, which tell no pixel its place.
DecodedMap decode(const CapturedView& pictures, const PatternSequence& sequence,
                  const DecodeOptions& options = {});

/// Rejects what is steep; as decode() says.
void reject_steep(DecodedMap& map, double max_neighbour_step_px);

}  // namespace laterna
