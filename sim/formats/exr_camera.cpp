#include "sim/formats/exr_camera.h"

#include "sim/error.h"
#include "sim/formats/parts.h"
#include "sim/image_codec.h"

#include <fmt/format.h>

#include <cmath>

namespace laterna {

namespace {

constexpr double tolerance = 1e-5;  // single precision, and matrices that were composed in it

[[noreturn]] void refuse(const std::string& place, const std::string& what) {
  throw InputError(fmt::format("{}: {}", place, what));
}

// Device frame to OpenEXR's camera frame and back: y turns round, and with it the hand.
glm::dmat4 y_flipped() { return glm::dmat4(glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, 1)); }

// (x', y', z', w') = (s, q - t, r, q): its own inverse.
glm::dmat4 window_from_texture() { return {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1}; }

glm::dmat4 finite(const std::optional<glm::mat4>& matrix, const char* name, const std::string& place) {
  if (!matrix)
    refuse(place, fmt::format("holds no {}, expected worldToCamera and worldToNDC of a pinhole", name));
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite((*matrix)[c][r])) refuse(place, fmt::format("{} is not finite", name));
  return glm::dmat4(*matrix);
}

Rigid placement(const glm::dmat4& camera_from_world, const std::string& place) {
  const glm::dmat4 d = y_flipped() * camera_from_world;
  if (d[0].w != 0 || d[1].w != 0 || d[2].w != 0 || d[3].w != 1)
    refuse(place, "worldToCamera's last column is not 0, 0, 0, 1, expected a rigid motion");
  if (glm::determinant(glm::dmat3(d)) < 0)
    refuse(place, "worldToCamera is right-handed, expected OpenEXR's camera: x right, y up, z forward");
  return rigid_from_rotation_rows(
      std::vector<double>{d[0].x, d[1].x, d[2].x, d[0].y, d[1].y, d[2].y, d[0].z, d[1].z, d[2].z},
      glm::dvec3(d[3]), place + ": worldToCamera");
}

// Rows x', y', w' over the device's frame: w·[fx/W 0 (cx+½)/W; 0 fy/H (cy+½)/H; 0 0 1].
Intrinsics pinhole(const glm::dmat4& window_from_device, glm::ivec2 size, const std::string& place) {
  const glm::dmat4& m = window_from_device;
  const double depth = m[2].w, fx = m[0].x / depth, fy = m[1].y / depth;
  if (!(depth > 0) || std::abs(m[0].w) + std::abs(m[1].w) > tolerance * depth)
    refuse(place, "worldToNDC's w is not the depth of worldToCamera's camera, expected a perspective view");
  if (!(fx > 0 && fy > 0))
    refuse(place, "worldToNDC's x or y runs backwards, expected OpenEXR's: x right, y down");
  if (std::abs(m[1].x) + std::abs(m[0].y) > tolerance * depth * std::min(fx, fy))
    refuse(place, "worldToNDC is skewed, expected a pinhole: no device here has a skew");
  const glm::dvec2 center_px = pixel_from_texture(window_from_texture() * m[2], size);  // of the axis
  return {size, fx * size.x, fy * size.y, center_px.x, center_px.y};
}

// Whether x', y' and w' vanish at the camera's centre, within 1e-5 of the distances that cancel there.
bool meets(const glm::dmat4& window_from_world, const glm::dvec3& center_world) {
  const glm::dmat4 rows = glm::transpose(window_from_world);
  for (const int row : {0, 1, 3}) {
    const glm::dvec3 n(rows[row]);
    const double range = glm::length(n) * (glm::length(center_world) + 1) + std::abs(rows[row].w);
    if (std::abs(glm::dot(n, center_world) + rows[row].w) > tolerance * range) return false;
  }
  return true;
}

}  // namespace

PictureCamera picture_camera(const Device& device) {
  PictureCamera camera{device.name, glm::mat4(y_flipped() * matrix_of(device.device_from_world)), {}};
  if (is_pinhole(device.lens))
    camera.window_from_world = glm::mat4(window_from_texture() * texture_from_world(device));
  return camera;
}

Device device_of(const PictureCamera& camera, glm::ivec2 window, const std::string& place) {
  const glm::dmat4 camera_from_world = finite(camera.camera_from_world, "worldToCamera", place),
                   window_from_world = finite(camera.window_from_world, "worldToNDC", place);
  Device device;
  device.name = camera.name;
  device.device_from_world = placement(camera_from_world, place);
  if (!meets(window_from_world, center_in_world(device.device_from_world)))
    refuse(place, "worldToNDC sees from another place than worldToCamera, expected one camera");
  const glm::dmat3 world_from_device = glm::transpose(device.device_from_world.rotation);
  device.intrinsics = pinhole(window_from_world * glm::dmat4(world_from_device), window, place);
  return device;
}

Device read_exr_camera(const std::filesystem::path& path) {
  const Picture picture = read_picture(path);
  Device device = device_of(picture.camera, picture.window, path.string());
  if (device.name.empty()) device.name = path.stem().string();
  return device;
}

std::string exr_camera_bytes(const Device& device) {
  if (!is_pinhole(device.lens))
    throw InputError(fmt::format("EXR holds no lens, \"{}\" has {}", device.name, device.lens.model));
  const std::uint8_t black = 0;
  const PictureView view{
      &black, 1, 1, 1, PixelType::u8, {"Y"}, picture_camera(device), device.intrinsics.size};
  const std::vector<unsigned char> bytes = image_codec().encode(device.name + ".exr", view);
  return {bytes.begin(), bytes.end()};
}

}  // namespace laterna
