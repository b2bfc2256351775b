// How good a decoded map is, with no truth to compare to.
#pragma once

#include "calib/decoded_map.h"

namespace laterna {

struct LocalResidualOptions {
  int window = 17;       ///< camera pixels along each side of a window, at least 3
  int min_decoded = 64;  ///< windows with fewer valid pixels are left out; at least 8
};

/// The median, over windows that tile the camera's picture, of how far the map is from smooth: in each window
/// a homography projector_from_camera is fitted to the valid pixels (least squares in projector pixels), and
/// its residual is sqrt(mean(du² + dv²)), in projector pixels.
///
/// An exact integer code on a plane gives sqrt(2/12) = 0.408 where the projector's pixels are much finer than
/// the camera's, and less where the homography can follow the rounding. Edges of the scene disturb few
/// windows, which the median does not see. Throws InputError for options out of range, and Refusal where no
/// window has enough valid pixels.
double median_local_residual_px(const DecodedMap& map, const LocalResidualOptions& options = {});

}  // namespace laterna
