// What a decoded sequence says about itself: shares, orientation, and what looks wrong, in words.
#pragma once

#include "calib/code_steps.h"
#include "calib/decoded_map.h"
#include "calib/group_places.h"
#include "calib/orientation.h"
#include "calib/repeat_check.h"
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
  std::vector<GroupMisfit> misfits;   ///< of a coded sequence
  std::optional<CodeSteps> steps;     ///< of Gray codes whose pictures do not belong together
  std::vector<GroupPlace> places;     ///< of a sequence with fringes
  std::optional<RepeatCheck> repeat;  ///< where the sequence shows its first picture again
  std::vector<std::string> flags;     ///< sentences; empty where nothing looks wrong
  /// Those of the flags that tell of errors which no sigma holds: an estimate from such a map is `weak`.
  std::vector<std::string> doubts;
};

/// Flags: a mirrored picture, or one whose handedness differs from place to place; more than two fifths of
/// the lit pixels rejected for one reason; fringes that sum to something else than half of white and black
/// (misfit above 0.08: a response that is not linear); one group that does so more than three times as much
/// as the median group (and above 0.03: a dropped or exchanged picture); pixels outside black and white;
/// nothing lit; Gray codes whose coarser pictures show another place than the finer ones; groups of pictures
/// with fringes that show other places than the rest; a repeated first
/// picture that differs from the first.
///
/// Doubts are: a dropped or exchanged picture; a response that is bent so much that it would shift places by
/// more than 0.1 px (bent_response.h), or at all for micro_phase, which compares single pictures; pixels
/// outside black and white; a rig or a scene that moved.
DecodeReport report_on(const CapturedView& pictures, const PatternSequence& sequence, const DecodedMap& map);

}  // namespace laterna
