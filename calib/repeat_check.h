// A first picture that is shown again at the end: where rig and scene stood still, both photographs are equal
// within the noise.
#pragma once

#include "sim/image_view.h"
#include "sim/pattern_sequence.h"

#include <optional>
#include <string>

namespace laterna {

/// The same sequence, and the same pictures where they are, without the repeated one. Throws InputError where
/// the number of pictures is not picture_count(sequence).
PatternSequence without_repeat(PatternSequence sequence);
CapturedView without_repeat(const CapturedView& pictures, const PatternSequence& sequence);

struct RepeatCheck {
  std::size_t lit = 0;       ///< pixels looked at: white - black is above 40/255 of the full scale
  double changed_share = 0;  ///< of them, those where both differ beyond noise and lamp
};

/// A pixel has changed where |last - first| > 8·sqrt(2)·sigma + 0.03·(white - black): noise of `sigma` as
/// sum_noise_dn() measures it, at most twice as bright as typical, and a lamp that wavers by 3 %. Nothing for
/// a sequence without a repeat.
std::optional<RepeatCheck> compare_repeat(const CapturedView& pictures, const PatternSequence& sequence);

/// More than one pixel in a thousand: a quarter of a pixel along the edge of the coarsest stripe is more.
bool has_moved(const RepeatCheck& check);

}  // namespace laterna
