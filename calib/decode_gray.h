// Pictures of Gray and XOR codes to projector pixels.
#pragma once

#include "calib/decoded_map.h"
#include "sim/image_view.h"
#include "sim/pattern_sequence.h"

#include <glm/glm.hpp>

namespace laterna {

/// When a camera pixel counts as decoded. A DN here is one of an 8-bit picture (1/255 of full scale); a
/// 16-bit stack takes the thresholds times (2^b - 1)/255, where b is the fewest bits from 8 to 16 that hold
/// its white picture.
///
/// OpenCV's rule: min_white_minus_black_dn = 40, min_pair_difference_dn = 5, the other two 0.
struct GrayDecodeOptions {
  double min_white_minus_black_dn = 10;  ///< valid where white - black is greater
  double min_pair_difference_dn = 3;     ///< valid where every |pattern - inverse| is at least this
  double min_pair_fraction = 0.1;        ///< and at least this times (white - black)
  double min_pair_sigmas = 5;  ///< and at least this times √2·picture_noise_dn; 0: noise is not looked at
  bool subpixel = false;       ///< places between pixels from stripes' edges (calib/gray_crossing.h)
};

/// Decodes a Gray or an XOR code.
///
/// A bit is 1 where pattern > inverse; the column and the row are what word_code() makes of their bits.
/// `u_px`, `v_px` are integers: the centres of projector pixels. `sigma_px` = 1/√12, the standard deviation
/// of a uniform error of ±0.5 px (measured maps are a little better, and their errors are not independent
/// from pixel to pixel). `confidence` = min over bits of |pattern - inverse| / (white - black), at most 1,
/// and 0 where white ≤ black; it is given for pixels that are not valid too. A code outside the projector is
/// not valid.
///
/// Saturation is no error here: where pattern and inverse differ enough, the bit is right whatever the
/// brightness. Validity and values equal those of OpenCV 4.6's GrayCodePattern::getProjPixel under its rule
/// above.
///
/// Throws InputError where the number of pictures is not that of the sequence, or a threshold is not finite
/// or the stack is empty. The same bits for any number of threads.
DecodedMap decode_gray(const CapturedView& pictures, const PatternSequence& sequence,
                       const GrayDecodeOptions& options = {});

/// The same of a Gray code (sim/pattern.h) for `projector_size`.
DecodedMap decode_gray(const CapturedView& pictures, glm::ivec2 projector_size,
                       const GrayDecodeOptions& options = {});

/// Columns, rows and validity alone, as integers: what decode_gray finds, in a quarter of the memory.
struct GrayCodes {
  Image<std::uint16_t> column, row;  ///< meaningful where valid
  Image<std::uint8_t> valid;         ///< 1 or 0
};

/// Writes them into `codes`, whose memory is used again where the size is right.
void decode_gray_codes(const CapturedView& pictures, const PatternSequence& sequence,
                       const GrayDecodeOptions& options, GrayCodes& codes);

/// sum_noise_dn() of pairs: the pictures but the last two, two by two. Throws InputError where there are
/// fewer than two pictures.
double picture_noise_dn(const CapturedView& pictures, double min_white_minus_black);

}  // namespace laterna
