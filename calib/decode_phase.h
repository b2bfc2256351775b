// Pictures of the phase families to projector pixels.
#pragma once

#include "calib/decoded_map.h"
#include "calib/unwrap.h"
#include "sim/pattern_sequence.h"

#include <optional>

namespace laterna {

/// A DN here is one of an 8-bit picture (1/255 of full scale, as in calib/decode_gray.h).
struct PhaseDecodeOptions {
  double min_white_minus_black_dn = 10;  ///< as of Gray codes
  double min_modulation_dn = 4;          ///< of each fringe
  double min_modulation_sigmas = 5;      ///< a phase is known to 1/this radians, or better
  UnwrapLimits unwrap{};
  /// In the stack's own DN; absent: measured (calib/sum_check.h), at least the 1/√12 of rounding.
  std::optional<SampleNoise> noise{};
};

/// Decodes gray_phase, phase, multi_frequency and micro_phase.
///
/// u and v are places between pixels. `sigma_px` comes from modulation and noise (calib/fringe_fit.h) and
/// covers what contradicts the sinusoid. Where the camera sees the panel's pixels as boxes, phases are whole
/// numbers whatever the noise: with R = |mean exp(2πi·u)|, 1 for whole numbers and 0 for even spread, R/12 is
/// added to the variance of u (likewise v) where R > 5/√n. Beyond the middle of the outermost pixels the
/// light ends, and phases lean inwards: within half a pixel of those, 1/12 is added too. `confidence` is the
/// weakest fringe's modulation over (white - black)/2, at most 1.
///
/// Throws InputError where the number of pictures is not that of the sequence, the family is another, or an
/// option is not finite or negative. The same bits for any number of threads.
DecodedMap decode_phase(const CapturedView& pictures, const PatternSequence& sequence,
                        const PhaseDecodeOptions& options = {});

}  // namespace laterna
