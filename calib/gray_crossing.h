// Places between projector pixels from Gray codes: where a pattern and its inverse cross along camera rows
// and columns lies an edge between two projector pixels.
#pragma once

#include "calib/decoded_map.h"
#include "sim/image_view.h"
#include "sim/pattern_sequence.h"

namespace laterna {

/// Refines the whole-numbered u and v of a Gray or XOR code.
///
/// Where two camera pixels, neighbours or next to one that is not valid, tell projector columns c and c ± 1,
/// one bit changes; its d = pattern - inverse crosses zero at i + d_i/(d_i - d_{i+1}), where u = c ± 0.5.
/// Between two crossings at most 16 camera pixels apart u is linear; of rows and columns the more certain is
/// taken. The sigma of a crossing is its noise, with 0.05 camera pixels for the edge's shape, and 1/√12
/// camera pixels where both samples are full: then the edge may lie anywhere between them. It counts with the
/// local projector pixels per camera pixel.
///
/// What the camera does not resolve (steps of two and more) stays a whole number with sigma 1/√12, so it pays
/// where a projector pixel covers more than one camera pixel. v likewise.
void refine_at_crossings(const CapturedView& pictures, const PatternSequence& sequence, DecodedMap& map);

}  // namespace laterna
