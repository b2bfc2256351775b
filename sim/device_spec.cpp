#include "sim/device_spec.h"

#include "sim/cameramodel_file.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <glm/trigonometric.hpp>
#include <initializer_list>
#include <vector>

namespace laterna {

namespace {

struct Key {
  const char* name;
  bool given;
};

/// Keys that together are one way to say a thing; the first is the one it cannot do without.
using Way = std::vector<Key>;

const char* first_given(const Way& way) {
  for (const Key& key : way)
    if (key.given) return key.name;
  return nullptr;
}

[[noreturn]] void fail(const std::string& what, const std::string& sentence) {
  throw InputError(what + ": " + sentence);
}

void check_one_way(const std::string& what, const char* thing, const std::vector<Way>& ways,
                   const char* expected) {
  const char* found = nullptr;
  for (const Way& way : ways) {
    const char* key = first_given(way);
    if (key && found) {
      fail(what, fmt::format("{} given in two ways, by {} and by {}, expected one of: {}", thing, found, key,
                             expected));
    }
    if (!key) continue;
    if (!way[0].given) fail(what, fmt::format("{} is given without {}", key, way[0].name));
    found = key;
  }
  if (!found) fail(what, fmt::format("{} missing, expected one of: {}", thing, expected));
}

void check_intrinsics_ways(const DeviceSpec& s, const std::string& what) {
  const bool model = !s.cameramodel.empty();
  check_one_way(what, "intrinsics are",
                {{{"fx", s.fx.has_value()},
                  {"fy", s.fy.has_value()},
                  {"cx", s.cx.has_value()},
                  {"cy", s.cy.has_value()}},
                 {{"throw_ratio", s.throw_ratio.has_value()}, {"lens_shift", s.lens_shift.has_value()}},
                 {{"fov_y_deg", s.fov_y_deg.has_value()}},
                 {{"fov_x_deg", s.fov_x_deg.has_value()}},
                 {{"cameramodel", model}}},
                "fx (with fy, cx, cy), throw_ratio (with lens_shift), fov_y_deg or fov_x_deg (with aspect), "
                "cameramodel");
  if (s.aspect && !s.fov_y_deg && !s.fov_x_deg) fail(what, "aspect is given without fov_y_deg or fov_x_deg");
  if (model && s.size) fail(what, "size is given beside cameramodel, which holds it, expected one of them");
  if (model && s.lens != Lens{})
    fail(what, "lens is given beside cameramodel, which holds it, expected one of them");
  if (!model && !s.size) fail(what, "size is missing, expected [width, height] in pixels");
}

void check_placement_ways(const DeviceSpec& s, const std::string& what) {
  check_one_way(
      what, "placement is",
      {{{"device_from_world", s.device_from_world.has_value()}},
       {{"position", s.position.has_value()}, {"look_at", s.look_at.has_value()}, {"up", s.up.has_value()}},
       {{"rotation_vector_rad", s.rotation_vector_rad.has_value()}},
       {{"quaternion_wxyz", s.quaternion_wxyz.has_value()}},
       {{"cameramodel", !s.cameramodel.empty()}}},
      "device_from_world, position with look_at, rotation_vector_rad with translation, "
      "quaternion_wxyz with translation, cameramodel");
  if (s.position && !s.look_at) fail(what, "position is given without look_at");
  const bool turned = s.rotation_vector_rad || s.quaternion_wxyz;
  if (turned && !s.translation)
    fail(what, fmt::format("{} is given without translation",
                           s.rotation_vector_rad ? "rotation_vector_rad" : "quaternion_wxyz"));
  if (!turned && s.translation)
    fail(what, "translation is given without rotation_vector_rad or quaternion_wxyz");
}

// The stand-ins below for absent values are never used once check_ways() has passed, and validation refuses
// them.
Intrinsics intrinsics_of(const DeviceSpec& s) {
  const glm::ivec2 size = s.size.value_or(glm::ivec2(0));
  const double aspect = s.aspect.value_or(double(size.x) / size.y);
  if (s.throw_ratio) return intrinsics_from_throw(size, *s.throw_ratio, s.lens_shift.value_or(glm::dvec2(0)));
  if (s.fov_y_deg) return intrinsics_from_fov_y(size, glm::radians(*s.fov_y_deg), aspect);
  if (s.fov_x_deg) return intrinsics_from_fov_x(size, glm::radians(*s.fov_x_deg), aspect);
  const double fx = s.fx.value_or(0);
  return {size, fx, s.fy.value_or(fx), s.cx.value_or((size.x - 1) / 2.0), s.cy.value_or((size.y - 1) / 2.0)};
}

Rigid placement_of(const DeviceSpec& s) {
  const glm::dvec3 translation = s.translation.value_or(glm::dvec3(0));
  if (s.position)
    return device_from_world_looking_at(*s.position, s.look_at.value_or(*s.position),
                                        s.up.value_or(glm::dvec3(0, 0, 1)));
  if (s.rotation_vector_rad) return rigid_from_rotation_vector(*s.rotation_vector_rad, translation);
  if (s.quaternion_wxyz) {
    const glm::dvec4& q = *s.quaternion_wxyz;
    return rigid_from_quaternion(glm::dquat(q[0], q[1], q[2], q[3]), translation);
  }
  return rigid_from_rows(s.device_from_world.value_or(Matrix3x4{}), "device_from_world");
}

}  // namespace

void check_ways(const DeviceSpec& spec, const std::string& what) {
  check_intrinsics_ways(spec, what);
  check_placement_ways(spec, what);
}

Device device_of(const DeviceSpec& spec, const std::filesystem::path& folder, const std::string& what) {
  check_ways(spec, what);
  try {
    Device device;
    if (!spec.cameramodel.empty()) {
      device = read_cameramodel(folder / spec.cameramodel);
    } else {
      device.intrinsics = intrinsics_of(spec);
      device.device_from_world = placement_of(spec);
      device.lens = spec.lens;
    }
    device.name = spec.name;
    device.planes = {spec.near_m, spec.far_m};
    validate(device.intrinsics, "intrinsics");
    validate(device.planes, "light planes");
    [[maybe_unused]] const LensProjection usable(device.intrinsics, device.lens);
    rigid_from_rows(rows_of(device.device_from_world), "device_from_world");
    return device;
  } catch (const InputError& error) {
    fail(what, error.what());
  }
}

}  // namespace laterna
