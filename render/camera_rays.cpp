#include "render/camera_rays.h"

#include "sim/parallel.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace laterna {

CameraRays::CameraRays(const Device& camera)
    : width_(camera.intrinsics.size.x),
      height_(camera.intrinsics.size.y),
      pinhole_(is_pinhole(camera.lens)),
      cx_(camera.intrinsics.cx),
      cy_(camera.intrinsics.cy),
      inverse_fx_(1 / camera.intrinsics.fx),
      inverse_fy_(1 / camera.intrinsics.fy) {
  const LensProjection lens(camera.intrinsics, camera.lens);
  if (pinhole_) return;
  table_ = PixelArray<glm::dvec2>(width_, height_);
  parallel_for(height_, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    std::optional<glm::dvec3> neighbour;
    for (int x = 0; x < width_; ++x) {
      const auto direction = lens.unproject({x, y}, neighbour);
      table_(x, y) =
          direction ? glm::dvec2(*direction) : glm::dvec2(std::numeric_limits<double>::quiet_NaN());
      if (direction) neighbour = direction;
    }
  });
}

// Per pixel, between the neighbours on both sides along one axis; one-sided at the image's edge.
glm::dvec2 CameraRays::slope(int x, int y, int along_x, int along_y) const {
  const int x0 = std::max(x - along_x, 0), x1 = std::min(x + along_x, width_ - 1);
  const int y0 = std::max(y - along_y, 0), y1 = std::min(y + along_y, height_ - 1);
  const int steps = x1 - x0 + y1 - y0;
  if (steps == 0) return {along_x * inverse_fx_, along_y * inverse_fy_};
  return (table_(x1, y1) - table_(x0, y0)) / double(steps);
}

}  // namespace laterna
