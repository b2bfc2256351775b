// One value of a picture between its pixels.
#pragma once

#include "render/projective_lookup.h"
#include "sim/image.h"

namespace laterna {

/// Bilinear between pixel centres (integer coordinates); half a pixel from the edge and beyond, the edge's
/// value.
inline double bilinear_value(const Image<float>& image, const glm::dvec2& pixel) {
  const LinearTaps x = linear_taps(pixel.x, image.width), y = linear_taps(pixel.y, image.height);
  const auto row = [&](int j) {
    return glm::mix(double(image(x.first, j)), double(image(x.second, j)), x.share);
  };
  return glm::mix(row(y.first), row(y.second), y.share);
}

}  // namespace laterna
