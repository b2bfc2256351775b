#include "sim/resample.h"

namespace laterna {

double resampled_place_px(double place_px, double scale) { return scale * (place_px + 0.5) - 0.5; }

Intrinsics resampled(const Intrinsics& k, double scale) {
  return {glm::max(glm::ivec2(1), glm::ivec2(scale * glm::dvec2(k.size))), scale * k.fx, scale * k.fy,
          resampled_place_px(k.cx, scale), resampled_place_px(k.cy, scale)};
}

}  // namespace laterna
