// Rigid motions, named by the frames they join: `b_from_a` takes coordinates in frame a to coordinates in
// frame b.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>

namespace laterna {

/// x_b = rotation·x_a + translation. Unit: metres. Value-initialised: the identity.
struct Rigid {
  glm::dmat3 rotation{1.0};
  glm::dvec3 translation{0.0};
};

/// x_b = apply(b_from_a, x_a).
inline glm::dvec3 apply(const Rigid& b_from_a, const glm::dvec3& x_a) {
  return b_from_a.rotation * x_a + b_from_a.translation;
}

/// c_from_a = compose(c_from_b, b_from_a).
Rigid compose(const Rigid& c_from_b, const Rigid& b_from_a);

/// a_from_b = inverse(b_from_a).
Rigid inverse(const Rigid& b_from_a);

/// The origin of frame a's device in frame b coordinates, for device_from_world: the device's centre in the
/// world.
glm::dvec3 center_in_world(const Rigid& device_from_world);

/// The homogeneous 4×4 matrix of a rigid motion (GLM: column-major storage, column vectors).
glm::dmat4 matrix_of(const Rigid& b_from_a);

/// From the rows of a 3×4 matrix [R | t]. Throws InputError, naming `what`, where a number is not finite,
/// where R·Rᵀ differs from the identity by more than 1e-6 in any entry, or where det R < 0 (a reflection).
Rigid rigid_from_rows(const std::array<std::array<double, 4>, 3>& rows, const char* what);

/// The rows of [R | t]; the inverse of rigid_from_rows.
std::array<std::array<double, 4>, 3> rows_of(const Rigid& b_from_a);

/// A device at `position_world` that looks at `target_world`: +z goes to the target, and `up_world` appears
/// upwards in the picture (towards -y: x right, y down, z forward). Throws InputError where the target is the
/// position, or `up` is parallel to the line of sight.
Rigid device_from_world_looking_at(const glm::dvec3& position_world, const glm::dvec3& target_world,
                                   const glm::dvec3& up_world);

/// From a Rodrigues vector (axis times angle in radians, as OpenCV's rvec) and a translation.
Rigid rigid_from_rotation_vector(const glm::dvec3& rotation_vector_rad, const glm::dvec3& translation);

/// The Rodrigues vector of a rotation, of length at most π.
glm::dvec3 rotation_vector_rad(const glm::dmat3& b_from_a);

/// From a quaternion (w, x, y, z), of any length but 0, and a translation. Throws InputError for a zero
/// quaternion.
Rigid rigid_from_quaternion(const glm::dquat& quaternion_wxyz, const glm::dvec3& translation);

}  // namespace laterna
