#include "sim/device.h"

#include <limits>

namespace laterna {

void validate(const Device& device) {
  validate(device.intrinsics, device.name.c_str());
  validate(device.planes, device.name.c_str());
  LensProjection(device.intrinsics, device.lens);
}

WorldProjection::WorldProjection(const Device& device)
    : lens_(device.intrinsics, device.lens),
      texture_from_world_(texture_from_world(device)),
      world_from_device_(inverse(device.device_from_world)) {}

glm::dvec3 WorldProjection::project(const glm::dvec3& x_world) const {
  const glm::dvec4 strq = texture_from_world_ * glm::dvec4(x_world, 1.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  if (!(strq.w > 0)) return {nan, nan, strq.w};
  const auto pixel = lens_.warp(pixel_from_texture(strq, lens_.intrinsics().size));
  return pixel ? glm::dvec3(*pixel, strq.w) : glm::dvec3(nan, nan, strq.w);
}

std::optional<glm::dvec3> WorldProjection::unproject(const glm::dvec2& pixel, double depth_m) const {
  const auto direction = lens_.unproject(pixel);
  if (!direction) return std::nullopt;
  return apply(world_from_device_, *direction * depth_m);
}

}  // namespace laterna
