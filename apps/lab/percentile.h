// The value below which most of a picture lies: where a colour scale ends.
#pragma once

#include "sim/image.h"

namespace laterna {

/// The 99th percentile of a picture's finite values; 0 where it has none.
double percentile_99(const Image<float>& image);

}  // namespace laterna
