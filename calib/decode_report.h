// What a decoded sequence says about itself: shares, orientation, and what looks wrong, in words.
#pragma once

#include "calib/decoded_map.h"
#include "calib/orientation.h"
#include "calib/sum_check.h"

#include <array>
#include <string>
#include <vector>

namespace laterna {

/// "dim", "saturated", ...: the names of Reject.
const char* reject_name(Reject reason);

struct DecodeReport {
  double valid_percent = 0;
  std::array<double, reject_reasons> percent{};  ///< of all pixels, by Reject; percent[0] is valid_percent
  Orientation orientation;
  std::vector<GroupMisfit> misfits;  ///< of a coded sequence
  std::vector<std::string> flags;    ///< sentences; empty where nothing looks wrong
};

/// Flags: a mirrored picture, or one whose handedness differs from place to place; more than two fifths of
/// the lit pixels rejected for one reason; fringes that sum to something else than half of white and black
/// (misfit above 0.08: a response that is not linear); one group that does so more than three times as much
/// as the median group (and above 0.03: a dropped or exchanged picture); pixels outside black and white;
/// nothing lit.
DecodeReport report_on(const CapturedStack& pictures, const PatternSequence& sequence, const DecodedMap& map);

}  // namespace laterna
