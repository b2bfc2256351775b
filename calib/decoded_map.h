// What decoding gives, whatever the patterns were.
#pragma once

#include "sim/image.h"

#include <cstdint>

namespace laterna {

/// Why a camera pixel tells no projector pixel.
enum class Reject : std::uint8_t {
  none,       ///< it does
  dim,        ///< white - black, or the fringe's modulation, is too small
  saturated,  ///< fewer than three samples of a fringe are below full scale
  pair,       ///< a pattern is too near to its inverse: a stripe's edge, blur, a dropped picture
  disagree,   ///< the fringes, or code and fringe, do not tell one and the same place
  outside,    ///< the place is no pixel of the projector
  steep       ///< it is far from what all its neighbours tell
};
inline constexpr int reject_reasons = 7;

/// For each camera pixel, the projector pixel that lit it. All pictures have the camera's size.
struct DecodedMap {
  int width = 0, height = 0;  ///< of the camera's picture
  Image<double> u_px, v_px;   ///< projector pixels, integers at pixel centres; NaN where not valid
  Image<float> sigma_px;  ///< one standard deviation of u and v: sqrt((σ_u² + σ_v²)/2); NaN where not valid
  Image<std::uint8_t> valid;  ///< 1 or 0
  Image<float> confidence;    ///< 0 (no signal) to 1; the decoder says how it is measured
  Image<Reject> why;          ///< none exactly where valid

  DecodedMap() = default;
  DecodedMap(int width_px, int height_px)
      : width(width_px),
        height(height_px),
        u_px(width_px, height_px),
        v_px(width_px, height_px),
        sigma_px(width_px, height_px),
        valid(width_px, height_px),
        confidence(width_px, height_px),
        why(width_px, height_px) {}
};

/// Makes pixel i tell nothing: not valid, with NaN for place and sigma.
void reject(DecodedMap& map, std::size_t i, Reject why);

}  // namespace laterna
