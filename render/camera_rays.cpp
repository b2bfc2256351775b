#include "render/camera_rays.h"

#include "sim/parallel.h"

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

}  // namespace laterna
