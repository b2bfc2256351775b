// A scene, ready to be rendered: what exists, in SI units and world coordinates (metres).
#pragma once

#include "sim/device.h"
#include "sim/image.h"
#include "sim/mesh.h"
#include "sim/sensor.h"

#include <glm/glm.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace laterna {

/// A mesh in the world with a Lambertian surface, lit and seen on its front side; the back side is seen, but
/// black.
struct Object {
  std::string name;
  Mesh mesh;
  glm::dmat4 world_from_object{1.0};  ///< affine; may scale
  double albedo = 0.8;                ///< reflected over incident light, 0 to 1
  /// Multiplies `albedo`, linear, one channel; looked up with the mesh's texture coordinates (s right, t up,
  /// repeated), bilinearly. Empty: constant albedo.
  std::shared_ptr<const Image<float>> albedo_map;
};

enum class Lookup { nearest, bilinear };  ///< nearest: a panel pixel is a box
enum class Border { black, clamp };       ///< beyond the picture's edge: no light, or the edge texel's

/// A projector: a device that emits.
struct Projector {
  Device device;
  double flux_lm =
      1000;  ///< of the all-white picture, shared evenly by the panel's pixels: Φ = flux_lm / (W·H)
  Lookup lookup = Lookup::nearest;
  Border border = Border::black;
};

/// A camera: a device that measures.
struct Camera {
  Device device;
  Sensor sensor;
};

enum class PatternKind { gray };

/// The whole scene.
struct Scene {
  std::vector<Object> objects;
  std::vector<Projector> projectors;
  std::vector<Camera> cameras;
  double ambient_lx = 0;  ///< uniform illuminance on every surface, from everywhere
  PatternKind patterns = PatternKind::gray;
};

}  // namespace laterna
