#include "render/projective_lookup.h"

namespace laterna {

ProjectiveLookup::ProjectiveLookup(const Projector& projector, const glm::dmat4& world_from_object)
    : terms_{{},
             {},
             {},
             projector.device.planes.near_m.value_or(0.0),
             projector.device.planes.far_m.value_or(std::numeric_limits<double>::infinity()),
             double(projector.device.intrinsics.size.x),
             double(projector.device.intrinsics.size.y),
             projector.device.intrinsics.fx * projector.device.intrinsics.fy,
             projector.border == Border::clamp},
      pinhole_(laterna::is_pinhole(projector.device.lens)),
      lens_(projector.device.intrinsics, projector.device.lens) {
  const Device& device = projector.device;
  const glm::dmat4x3 pixel = pixel_from_object(
      texture_from_object(device.intrinsics, device.planes, device.device_from_world, world_from_object),
      device.intrinsics.size);
  for (int i = 0; i < 4; ++i) {
    terms_.u[i] = pixel[i].x;
    terms_.v[i] = pixel[i].y;
    terms_.q[i] = pixel[i].z;
  }
}

bool ProjectiveLookup::warp(ProjectedPoint& point) const {
  const Intrinsics& k = lens_.intrinsics();
  const glm::dvec3 x_device((point.u_px - k.cx) / k.fx, (point.v_px - k.cy) / k.fy, 1.0);
  const auto warped = lens_.project(x_device);
  if (!warped) return false;
  point.u_px = warped->x, point.v_px = warped->y;
  point.pixels_per_unit_area = lens_.pixels_per_unit_area(x_device);
  return true;
}

}  // namespace laterna
