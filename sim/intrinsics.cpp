#include "sim/intrinsics.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <cmath>

namespace laterna {

namespace {

constexpr int max_size_px = 16384;

Intrinsics centred(glm::ivec2 size, double fx, double fy) {
  return {size, fx, fy, (size.x - 1) / 2.0, (size.y - 1) / 2.0};
}

}  // namespace

void validate(const Intrinsics& k, const char* what) {
  if (k.size.x < 1 || k.size.y < 1 || k.size.x > max_size_px || k.size.y > max_size_px) {
    throw InputError(fmt::format("{}: size is {} × {}, expected 1 to {} pixels each", what, k.size.x,
                                 k.size.y, max_size_px));
  }
  for (const double number : {k.fx, k.fy, k.cx, k.cy}) {
    if (!std::isfinite(number))
      throw InputError(fmt::format("{}: fx, fy, cx or cy is {}, expected finite numbers", what, number));
  }
  // Between a hundredth of a pixel and a hundred million: beyond, K is singular to working precision.
  for (const double f : {k.fx, k.fy}) {
    if (!(f > 1e-2 && f < 1e8)) {
      throw InputError(fmt::format(
          "{}: focal length is {} px, expected between 0.01 and 1e8: the intrinsics are singular", what, f));
    }
  }
}

Intrinsics intrinsics_from_throw(glm::ivec2 size, double throw_ratio, glm::dvec2 lens_shift) {
  const double f = throw_ratio * size.x;
  Intrinsics k = centred(size, f, f);
  k.cx += lens_shift.x * size.x;
  k.cy += lens_shift.y * size.y;
  return k;
}

Intrinsics intrinsics_from_fov_y(glm::ivec2 size, double fov_y_rad, double aspect) {
  const double half = std::tan(fov_y_rad / 2);
  return centred(size, size.x / (2 * aspect * half), size.y / (2 * half));
}

Intrinsics intrinsics_from_fov_x(glm::ivec2 size, double fov_x_rad, double aspect) {
  const double half = std::tan(fov_x_rad / 2);
  return centred(size, size.x / (2 * half), aspect * size.y / (2 * half));
}

}  // namespace laterna
