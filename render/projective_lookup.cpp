#include "render/projective_lookup.h"

#include <limits>

namespace laterna {

ProjectiveLookup::ProjectiveLookup(const Projector& projector, const glm::dmat4& world_from_object)
    : near_m_(projector.device.planes.near_m.value_or(0.0)),
      far_m_(projector.device.planes.far_m.value_or(std::numeric_limits<double>::infinity())),
      width_(projector.device.intrinsics.size.x),
      height_(projector.device.intrinsics.size.y),
      pinhole_area_(projector.device.intrinsics.fx * projector.device.intrinsics.fy),
      clamp_(projector.border == Border::clamp),
      pinhole_(is_pinhole(projector.device.lens)),
      lens_(projector.device.intrinsics, projector.device.lens) {
  const Device& device = projector.device;
  const glm::dmat4x3 pixel = pixel_from_object(
      texture_from_object(device.intrinsics, device.planes, device.device_from_world, world_from_object),
      device.intrinsics.size);
  for (int i = 0; i < 4; ++i) {
    u_[i] = pixel[i].x;
    v_[i] = pixel[i].y;
    q_[i] = pixel[i].z;
  }
}

ProjectedPoint ProjectiveLookup::divide(const glm::dvec3& h) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  if (!(h.z > 0)) return {nan, nan, h.z, 0, Unlit::behind};
  const double inverse_q = 1 / h.z;
  ProjectedPoint point{h.x * inverse_q, h.y * inverse_q, h.z, pinhole_area_, Unlit::lit};
  if (!pinhole_) {
    const Intrinsics& k = lens_.intrinsics();
    const glm::dvec3 x_device((point.u_px - k.cx) / k.fx, (point.v_px - k.cy) / k.fy, 1.0);
    const auto warped = lens_.project(x_device);
    if (!warped) return {nan, nan, h.z, 0, Unlit::lens};
    point.u_px = warped->x, point.v_px = warped->y;
    point.pixels_per_unit_area = lens_.pixels_per_unit_area(x_device);
  }
  const bool inside =
      point.u_px >= -0.5 && point.u_px < width_ - 0.5 && point.v_px >= -0.5 && point.v_px < height_ - 0.5;
  if (h.z < near_m_) {
    point.why = Unlit::before_near;
  } else if (h.z > far_m_) {
    point.why = Unlit::beyond_far;
  } else if (!inside && !clamp_) {
    point.why = Unlit::outside;
  }
  return point;
}

}  // namespace laterna
