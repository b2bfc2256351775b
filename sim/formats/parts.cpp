#include "sim/formats/parts.h"

#include "sim/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace laterna {

namespace {

double distance_from_rotation(const glm::dmat3& r) {
  const glm::dmat3 off = r * glm::transpose(r) - glm::dmat3(1.0);
  double largest = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) largest = std::max(largest, std::abs(off[i][j]));
  return largest;
}

bool is_identity(const Rigid& motion) {
  return motion.rotation == glm::dmat3(1.0) && motion.translation == glm::dvec3(0.0);
}

}  // namespace

Intrinsics intrinsics_from_k(std::span<const double> k, glm::ivec2 size, const std::string& place) {
  if (k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1)
    throw InputError(fmt::format("{}: found [{}], expected fx, 0, cx, 0, fy, cy, 0, 0, 1", place, joined(k)));
  if (std::abs(k[1]) > 1e-9 * std::abs(k[0]))
    throw InputError(fmt::format("{}: a skew of {} px, expected 0: no device here has one", place, k[1]));
  return {size, k[0], k[4], k[2], k[5]};
}

std::vector<double> k_of(const Intrinsics& k) { return {k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1}; }

Rigid rigid_from_rotation_rows(std::span<const double> m, const glm::dvec3& translation,
                               const std::string& place) {
  // GLM is given columns: the transpose of the rows.
  glm::dmat3 r = glm::transpose(glm::dmat3(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]));
  const double distance = distance_from_rotation(r);
  if (!(distance <= 1e-3) || glm::determinant(r) < 0)
    throw InputError(fmt::format("{}: found [{}], expected a rotation row by row", place, joined(m)));
  if (distance > 1e-12)  // Newton's iteration for the polar decomposition: the error squares each time
    for (int i = 0; i < 4; ++i) r = 0.5 * (r + glm::transpose(glm::inverse(r)));
  return {r, translation};
}

std::vector<double> rotation_rows(const Rigid& motion) {
  std::vector<double> rows;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rows.push_back(motion.rotation[j][i]);
  return rows;
}

Lens lens_from_opencv(std::vector<double> c, const std::string& place) {
  if (c.size() == 14 && c[12] == 0 && c[13] == 0) c.resize(12);
  if (std::all_of(c.begin(), c.end(), [](double value) { return value == 0; }) && c.size() <= 12) return {};
  if (c.size() != 4 && c.size() != 5 && c.size() != 8 && c.size() != 12)
    throw InputError(fmt::format("{}: found {} coefficients{}, expected 4, 5, 8 or 12", place, c.size(),
                                 c.size() == 14 ? " with a tilted sensor" : ""));
  return {fmt::format("LENSMODEL_OPENCV{}", c.size()), c};
}

std::vector<double> opencv_coefficients(const Device& device, const char* format, std::size_t most) {
  if (!is_pinhole(device.lens) && !device.lens.model.starts_with("LENSMODEL_OPENCV"))
    throw InputError(
        fmt::format("{} holds OpenCV's lenses only, \"{}\" has {}", format, device.name, device.lens.model));
  if (device.lens.parameters.size() > most)
    throw InputError(fmt::format("{} holds at most {} distortion coefficients, \"{}\" has {}", format, most,
                                 device.name, device.lens.parameters.size()));
  return device.lens.parameters;
}

Rigid view_from_device() { return {glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1), {}}; }

bool names_projector(const std::string& name) {
  constexpr std::string_view beginning = "proj";
  return name.size() >= beginning.size() &&
         std::equal(beginning.begin(), beginning.end(), name.begin(),
                    [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

void add_by_name(Rig& rig, Device device) {
  auto& devices = names_projector(device.name) ? rig.projectors : rig.cameras;
  devices.push_back(std::move(device));
}

std::vector<Device> devices_of(const Rig& rig) {
  std::vector<Device> devices = rig.cameras;
  devices.insert(devices.end(), rig.projectors.begin(), rig.projectors.end());
  return devices;
}

void note_projectors(const Rig& rig, const char* format, Notes& notes) {
  for (const Device& projector : rig.projectors)
    notes.push_back(fmt::format("{} knows no projectors: \"{}\" stands as a camera{}", format, projector.name,
                                names_projector(projector.name) ? ", and its name tells" : " from now on"));
}

Rig relative_to(const Rig& rig, const Device& reference, const char* format, Notes& notes) {
  const Rigid reference_from_world = reference.device_from_world;
  if (is_identity(reference_from_world)) return rig;
  notes.push_back(fmt::format("{} has no world: places are kept relative to \"{}\"", format, reference.name));
  Rig moved = rig;
  const Rigid world_from_reference = inverse(reference_from_world);
  const std::string name = reference.name;
  for (auto* devices : {&moved.cameras, &moved.projectors})
    for (Device& device : *devices)
      device.device_from_world =
          device.name == name ? Rigid{} : compose(device.device_from_world, world_from_reference);
  return moved;
}

Rig scaled(Rig rig, double factor) {
  for (auto* devices : {&rig.cameras, &rig.projectors, &rig.given_cameras})
    for (Device& device : *devices) device.device_from_world.translation *= factor;
  return rig;
}

std::string joined(std::span<const double> numbers, const char* separator) {
  return fmt::format("{}", fmt::join(numbers, separator));
}

}  // namespace laterna
