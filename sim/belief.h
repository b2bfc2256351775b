// How what a solver is told of a scene differs from what is there: parameters, all without effect by default.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <string>

namespace laterna {

/// Of one mesh, in this order: another file, fewer triangles, noise, and a placement relative to the true
/// one. sim/believed.h applies it.
struct MeshBelief {
  std::string file{};
  double keep = 1;
  double noise_sigma_m = 0;
  std::uint64_t seed = 1;
  double scale = 1;
  glm::dvec3 rotate_deg{0, 0, 0};
  glm::dvec3 translate{0, 0, 0};
  bool operator==(const MeshBelief&) const = default;
};

/// Of one camera: the error of its placement and intrinsics, and the standard deviations that a solver is
/// told.
///   x_believed = Rz·Ry·Rx·x_device + translate,
/// turned about the camera's own centre, all in its own frame (x right, y down, z forward).
struct CameraBelief {
  glm::dvec3 rotate_deg{0, 0, 0};
  glm::dvec3 translate{0, 0, 0};
  glm::dvec2 focal_px{0, 0}, center_px{0, 0};
  glm::dvec3 sigma_rotate_deg{0, 0, 0};
  glm::dvec3 sigma_translate{0, 0, 0};
  glm::dvec2 sigma_focal_px{0, 0}, sigma_center_px{0, 0};
  bool operator==(const CameraBelief&) const = default;
};

}  // namespace laterna
