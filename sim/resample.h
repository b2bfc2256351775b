// The same view in more or fewer pixels.
#pragma once

#include "sim/intrinsics.h"

namespace laterna {

/// Where a place of an image comes to lie when the image is resampled to `scale` times its pixels:
///   place' + 1/2 = scale·(place + 1/2).
double resampled_place_px(double place_px, double scale);

/// The same view in `scale` times the pixels each way: fx and fy times scale, (cx, cy) as above; the size is
/// rounded down, at least 1, so that a rest at the right and lower edge is lost.
Intrinsics resampled(const Intrinsics& intrinsics, double scale);

}  // namespace laterna
