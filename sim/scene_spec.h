// What a scene file says, field by field: nothing loaded, nothing computed.
//
// A field that is absent in the file is absent here: an empty string, an empty optional, or the default. How
// the specification becomes a Scene is in sim/scene_build.h, what each field means in sim/scene_fields.h, how
// it is read and written in sim/scene_file.h.
#pragma once

#include "sim/fields.h"
#include "sim/image_file.h"
#include "sim/scene.h"
#include "sim/scene_limits.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace laterna {

enum class UpAxis { y, z };

/// A mesh: exactly one of `file`, `shape` and `board`. With unit, up and placement,
///   x_world = world_from_object · U · (unit · x_file),  U = identity (up = "z") or (x, y, z) → (x, -z, y)
///   (up = "y").
/// Where world_from_object is absent, x_world = translate + Rz·Ry·Rx · scale · U · (unit · x_file).
struct MeshSpec {
  std::string name{};
  std::string file{}, shape{}, board{};
  glm::dvec3 shape_size{1, 1, 1};
  int detail = 64;
  std::uint64_t seed = 1;
  std::string unit = "m";
  UpAxis up = UpAxis::z;
  std::optional<Matrix3x4> world_from_object{};
  double scale = 1;
  glm::dvec3 rotate_deg{0, 0, 0};
  glm::dvec3 translate{0, 0, 0};
  double albedo = 0.8;
  std::string albedo_map{};
  Encoding albedo_map_encoding = Encoding::srgb;
  MeshEffects effects{};
  MeshBelief believed{};
  bool operator==(const MeshSpec&) const = default;
};

/// The geometry of a projector or a camera: intrinsics in exactly one way, placement in exactly one way.
struct DeviceSpec {
  std::string name{};
  std::optional<glm::ivec2> size{};
  std::optional<double> fx{}, fy{}, cx{}, cy{};
  std::optional<double> throw_ratio{};
  std::optional<glm::dvec2> lens_shift{};
  std::optional<double> fov_y_deg{}, fov_x_deg{}, aspect{};
  std::string cameramodel{};
  std::optional<Matrix3x4> device_from_world{};
  std::optional<glm::dvec3> position{}, look_at{}, up{};
  std::optional<glm::dvec3> rotation_vector_rad{};
  std::optional<glm::dvec4> quaternion_wxyz{};
  std::optional<glm::dvec3> translation{};
  Lens lens{};
  std::optional<double> near_m{}, far_m{};
  bool operator==(const DeviceSpec&) const = default;
};

struct ProjectorSpec {
  DeviceSpec device{};
  double flux_lm = Projector{}.flux_lm;
  Lookup lookup = Projector{}.lookup;
  Border border = Projector{}.border;
  ProjectorEffects effects{};
  bool operator==(const ProjectorSpec&) const = default;
};

struct CameraSpec {
  DeviceSpec device{};
  Sensor sensor{};
  Vignetting vignetting{};
  int samples_per_pixel = Camera{}.samples_per_pixel;
  Optics optics{};
  ColourFilter colour_filter = Camera{}.colour_filter;
  double veiling_glare = Camera{}.veiling_glare;
  CameraBelief believed{};
  bool operator==(const CameraSpec&) const = default;
};

struct PatternsSpec {
  PatternParameters parameters{};
  std::string file{};                ///< of a slide
  std::vector<std::string> files{};  ///< of pictures
  Encoding encoding = Encoding::srgb;
  glm::dvec3 colour{1, 1, 1};
  bool operator==(const PatternsSpec&) const = default;
};

/// A projector and a camera, by name, and nine numbers row by row: camera channel × projector primary.
struct ColourSpec {
  std::string projector{}, camera{};
  std::vector<double> mixing{};
  bool operator==(const ColourSpec&) const = default;
};

struct SceneSpec {
  std::string name{};
  double ambient_lx = 0;
  bool believe_truth = false;
  PatternsSpec patterns{};
  Effects effects{};
  InterReflection inter_reflection{};
  Timing timing{};
  std::vector<ColourSpec> colours{};
  std::vector<MeshSpec> meshes{};
  std::vector<ProjectorSpec> projectors{};
  std::vector<CameraSpec> cameras{};
  bool operator==(const SceneSpec&) const = default;
};

}  // namespace laterna
