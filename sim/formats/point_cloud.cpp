#include "sim/formats/point_cloud.h"

#include <fmt/format.h>

#include <bit>

namespace laterna {

namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

std::string point_cloud_ply(const std::vector<CloudPoint>& points) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
      "property double z\nproperty float projector_u\nproperty float projector_v\nproperty float camera_u\n"
      "property float camera_v\nend_header\n",
      points.size());
  for (const CloudPoint& p : points) {
    for (int i = 0; i < 3; ++i) append(bytes, p.x_world[i]);
    for (const glm::dvec2& pixel : {p.projector_px, p.camera_px})
      for (int i = 0; i < 2; ++i) append(bytes, float(pixel[i]));
  }
  return bytes;
}

}  // namespace laterna
