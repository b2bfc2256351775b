#include "sim/rq.h"

namespace laterna {

KAndR k_and_r(const glm::dmat3& m, glm::ivec2 size) {
  const glm::dmat3 rows = glm::transpose(m);
  const double scale = (glm::determinant(m) < 0 ? -1 : 1) * glm::length(rows[2]);
  const glm::dvec3 z = rows[2] / scale;
  const double cx = glm::dot(rows[0], z) / scale, cy = glm::dot(rows[1], z) / scale;
  const glm::dvec3 fy_y = rows[1] / scale - cy * z;
  const double fy = glm::length(fy_y);
  const glm::dvec3 y = fy_y / fy;
  const double skew_px = glm::dot(rows[0], y) / scale;
  const glm::dvec3 fx_x = rows[0] / scale - cx * z - skew_px * y;
  const double fx = glm::length(fx_x);
  return {{size, fx, fy, cx, cy}, glm::transpose(glm::dmat3(fx_x / fx, y, z)), skew_px, scale};
}

}  // namespace laterna
