// A 3×3 matrix of pixels apart into what a device is and how it is turned.
#pragma once

#include "sim/intrinsics.h"

#include <glm/glm.hpp>

namespace laterna {

/// scale·K·R, with K = [fx skew cx; 0 fy cy; 0 0 1].
struct KAndR {
  Intrinsics intrinsics;  ///< fx, fy > 0
  glm::dmat3 rotation{1.0};
  double skew_px = 0;
  double scale = 1;  ///< < 0 where the matrix's determinant is
};

/// RQ decomposition (Hartley and Zisserman, Multiple View Geometry, 2nd ed., A4.1.1): the K, R and scale
/// whose product is `m`, with fx, fy > 0 and det R = 1. `m` maps directions (x, y, z) to (u·q, v·q, q); it is
/// finite and not singular, which the caller sees to. `size` becomes the intrinsics'.
KAndR k_and_r(const glm::dmat3& m, glm::ivec2 size);

}  // namespace laterna
