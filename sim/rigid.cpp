#include "sim/rigid.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <cmath>

namespace laterna {

Rigid compose(const Rigid& c_from_b, const Rigid& b_from_a) {
  return {c_from_b.rotation * b_from_a.rotation, apply(c_from_b, b_from_a.translation)};
}

Rigid inverse(const Rigid& b_from_a) {
  const glm::dmat3 a_from_b = glm::transpose(b_from_a.rotation);
  return {a_from_b, -(a_from_b * b_from_a.translation)};
}

glm::dvec3 center_in_world(const Rigid& device_from_world) { return inverse(device_from_world).translation; }

glm::dmat4 matrix_of(const Rigid& b_from_a) {
  glm::dmat4 m(b_from_a.rotation);
  m[3] = glm::dvec4(b_from_a.translation, 1.0);
  return m;
}

Rigid rigid_from_rows(const std::array<std::array<double, 4>, 3>& rows, const char* what) {
  Rigid rigid;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 4; ++j) {
      if (!std::isfinite(rows[i][j]))
        throw InputError(fmt::format("{}: row {} holds {}, expected finite numbers", what, i, rows[i][j]));
      if (j < 3) rigid.rotation[j][i] = rows[i][j];
    }
    rigid.translation[i] = rows[i][3];
  }
  const glm::dmat3 gram = rigid.rotation * glm::transpose(rigid.rotation) - glm::dmat3(1.0);
  double worst = 0;
  for (int i = 0; i < 9; ++i) worst = std::max(worst, std::abs(gram[i / 3][i % 3]));
  if (worst > 1e-6) {
    throw InputError(
        fmt::format("{}: the left 3×3 block is no rotation: R·Rᵀ differs from the identity by {:.3g}, "
                    "expected at most 1e-6",
                    what, worst));
  }
  if (glm::determinant(rigid.rotation) < 0) {
    throw InputError(
        fmt::format("{}: the left 3×3 block is a reflection (determinant -1), expected a rotation", what));
  }
  return rigid;
}

std::array<std::array<double, 4>, 3> rows_of(const Rigid& b_from_a) {
  std::array<std::array<double, 4>, 3> rows{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rows[i][j] = b_from_a.rotation[j][i];
    rows[i][3] = b_from_a.translation[i];
  }
  return rows;
}

Rigid device_from_world_looking_at(const glm::dvec3& position_world, const glm::dvec3& target_world,
                                   const glm::dvec3& up_world) {
  const glm::dvec3 sight = target_world - position_world;
  if (!(glm::length(sight) > 0))
    throw InputError("look_at: the target is the position itself, expected another point");
  const glm::dvec3 forward = glm::normalize(sight);
  const glm::dvec3 right = glm::cross(forward, up_world);
  if (!(glm::length(right) > 1e-9 * glm::length(up_world))) {
    throw InputError("look_at: `up` is parallel to the line of sight, expected another direction");
  }
  const glm::dvec3 x = glm::normalize(right);
  const glm::dvec3 y = glm::cross(forward, x);
  const glm::dmat3 device_rows = glm::transpose(glm::dmat3(x, y, forward));
  return {device_rows, -(device_rows * position_world)};
}

Rigid rigid_from_rotation_vector(const glm::dvec3& rotation_vector_rad, const glm::dvec3& translation) {
  const double angle = glm::length(rotation_vector_rad);
  if (angle == 0) return {glm::dmat3(1.0), translation};
  return {glm::mat3_cast(glm::angleAxis(angle, rotation_vector_rad / angle)), translation};
}

glm::dvec3 rotation_vector_rad(const glm::dmat3& b_from_a) {
  glm::dquat q = glm::quat_cast(b_from_a);
  if (q.w < 0) q = -q;
  const glm::dvec3 axis_times_sine(q.x, q.y, q.z);
  const double sine = glm::length(axis_times_sine);
  if (sine == 0) return glm::dvec3(0.0);
  return axis_times_sine * (2 * std::atan2(sine, q.w) / sine);
}

Rigid rigid_from_quaternion(const glm::dquat& quaternion_wxyz, const glm::dvec3& translation) {
  const double length = glm::length(quaternion_wxyz);
  if (!(length > 0) || !std::isfinite(length))
    throw InputError("quaternion: its length is 0 or not finite, expected a rotation");
  return {glm::mat3_cast(quaternion_wxyz / length), translation};
}

}  // namespace laterna
