// Projectors and cameras: the same geometry, light running opposite ways.
#pragma once

#include "sim/lens.h"
#include "sim/texture_matrix.h"

#include <string>

namespace laterna {

/// The geometry of a projector or a camera. `planes` is used for projectors only.
struct Device {
  std::string name;
  Intrinsics intrinsics;
  Rigid device_from_world;
  Lens lens;
  LightPlanes planes;
};

/// Throws InputError, beginning with the device's name, where intrinsics, lens or planes are unusable.
void validate(const Device& device);

/// T of a device for world coordinates.
inline glm::dmat4 texture_from_world(const Device& device) {
  return texture_from_object(device.intrinsics, device.planes, device.device_from_world);
}

/// A device ready to project world points: T, then the divide, then the lens's warp.
class WorldProjection {
 public:
  explicit WorldProjection(const Device& device);
  const LensProjection& lens() const { return lens_; }

  /// (u, v, q): pixel and axial depth in metres. u and v are NaN where q ≤ 0 or the lens fails; q always
  /// stands.
  glm::dvec3 project(const glm::dvec3& x_world) const;

  /// The world point at axial depth `depth_m` on a pixel's ray; none where the lens fails.
  std::optional<glm::dvec3> unproject(const glm::dvec2& pixel, double depth_m) const;

 private:
  LensProjection lens_;
  glm::dmat4 texture_from_world_;
  Rigid world_from_device_;
};

}  // namespace laterna
