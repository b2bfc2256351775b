// What decoding gives, whatever the patterns were.
#pragma once

#include "sim/image.h"

#include <cstdint>

namespace laterna {

/// For each camera pixel, the projector pixel that lit it. All pictures have the camera's size.
struct DecodedMap {
  int width = 0, height = 0;  ///< of the camera's picture
  Image<double> u_px, v_px;   ///< projector pixels, integers at pixel centres; NaN where not valid
  Image<float> sigma_px;      ///< one standard deviation of each of u and v; NaN where not valid
  Image<std::uint8_t> valid;  ///< 1 or 0
  Image<float> confidence;    ///< 0 (no signal) to 1; the decoder says how it is measured

  DecodedMap() = default;
  DecodedMap(int width_px, int height_px)
      : width(width_px),
        height(height_px),
        u_px(width_px, height_px),
        v_px(width_px, height_px),
        sigma_px(width_px, height_px),
        valid(width_px, height_px),
        confidence(width_px, height_px) {}
};

}  // namespace laterna
