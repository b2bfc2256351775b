#include "apps/lab/capture_cloud.h"

#include "apps/lab/decode_folder.h"
#include "sim/error.h"
#include "sim/formats/parts.h"
#include "sim/image_file.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace laterna {

namespace {

namespace fs = std::filesystem;

std::vector<CaptureSequence> sequences_of(const fs::path& folder, const CloudOptions& options) {
  std::vector<CaptureSequence> fitting;
  for (const CaptureSequence& s : read_manifest(folder).sequences)
    if ((options.camera.empty() || options.camera == s.camera) &&
        (options.projector.empty() || options.projector == s.projector))
      fitting.push_back(s);
  if (fitting.empty()) throw InputError(fmt::format("{}: no sequence fits", folder.string()));
  return fitting;
}

const Image<float>& layer(const ExrLayers& layers, const std::string& name, const std::string& file) {
  for (std::size_t i = 0; i < layers.names.size(); ++i)
    if (layers.names[i] == name) return layers.planes[i];
  throw InputError(fmt::format("{}: no layer {}", file, name));
}

Device device_called(const Rig& rig, const std::string& name) {
  for (const Device& device : devices_of(rig))
    if (device.name == name) return device;
  throw InputError(fmt::format("the rig has no device \"{}\"", name));
}

// A device's rays in the world.
class Rays {
 public:
  explicit Rays(const Device& device)
      : projection_(device), origin_(center_in_world(device.device_from_world)) {}
  const glm::dvec3& origin() const { return origin_; }
  std::optional<glm::dvec3> direction(const glm::dvec2& pixel) const {
    const auto x = projection_.unproject(pixel, 1.0);
    if (!x) return std::nullopt;
    return glm::normalize(*x - origin_);
  }

 private:
  WorldProjection projection_;
  glm::dvec3 origin_;
};

constexpr double largest_gap = 0.01;  // of the distance

}  // namespace

bool midpoint(const glm::dvec3& origin_a, const glm::dvec3& a, const glm::dvec3& origin_b,
              const glm::dvec3& b, Midpoint& result) {
  const double ab = glm::dot(a, b), denominator = 1 - ab * ab;
  if (!(denominator > 1e-12)) return false;
  const glm::dvec3 between = origin_b - origin_a;
  result.along_a = (glm::dot(between, a) - ab * glm::dot(between, b)) / denominator;
  result.along_b = (ab * glm::dot(between, a) - glm::dot(between, b)) / denominator;
  const glm::dvec3 on_a = origin_a + result.along_a * a, on_b = origin_b + result.along_b * b;
  result.x = 0.5 * (on_a + on_b);
  result.gap_m = glm::distance(on_a, on_b);
  return true;
}

std::vector<CloudPoint> true_cloud(const fs::path& folder, const CloudOptions& options) {
  std::vector<CloudPoint> points;
  for (const CaptureSequence& sequence : sequences_of(folder, options)) {
    if (sequence.truth.empty())
      throw InputError(folder.string() + ": the capture has no truth, expected --decoded");
    const std::string file = (folder / sequence.truth).string();
    const ExrLayers truth = read_exr_layers(file);
    const auto of = [&](const char* name) -> const Image<float>& { return layer(truth, name, file); };
    const Image<float>&lit = of("projector.lit"), &x = of("world.x"), &y = of("world.y"), &z = of("world.z"),
          &u = of("projector.u"), &v = of("projector.v");
    for (int row = 0; row < lit.height; ++row)
      for (int column = 0; column < lit.width; ++column)
        if (lit(column, row) == 1)
          points.push_back({{x(column, row), y(column, row), z(column, row)},
                            {u(column, row), v(column, row)},
                            {column, row}});
  }
  return points;
}

void append_cloud(const DecodedMap& map, const Device& camera, const Device& projector,
                  std::vector<CloudPoint>& points) {
  const Rays eye(camera), source(projector);
  for (int row = 0; row < map.height; ++row)
    for (int column = 0; column < map.width; ++column) {
      if (!map.valid(column, row)) continue;
      const glm::dvec2 camera_px(column, row), projector_px(map.u_px(column, row), map.v_px(column, row));
      const auto a = eye.direction(camera_px), b = source.direction(projector_px);
      Midpoint m;
      if (!a || !b || !midpoint(eye.origin(), *a, source.origin(), *b, m)) continue;
      if (m.along_a > 0 && m.along_b > 0 && m.gap_m < largest_gap * m.along_a)
        points.push_back({m.x, projector_px, camera_px});
    }
}

std::vector<CloudPoint> decoded_cloud(const fs::path& folder, const Rig& rig, const CloudOptions& options) {
  std::vector<CloudPoint> points;
  for (const CaptureSequence& sequence : sequences_of(folder, options))
    append_cloud(decode_sequence(folder, sequence, {}).map, device_called(rig, sequence.camera),
                 device_called(rig, sequence.projector), points);
  return points;
}

}  // namespace laterna
