// A scene, ready to be rendered: what exists, in SI units and world coordinates (metres).
#pragma once

#include "sim/belief.h"
#include "sim/device.h"
#include "sim/effect_parameters.h"
#include "sim/effects.h"
#include "sim/image.h"
#include "sim/lookup.h"
#include "sim/mesh.h"
#include "sim/pattern_sequence.h"
#include "sim/sensor.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
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
  MeshEffects effects{};
  std::uint64_t seed = 1;  ///< draws the solid noise
  /// Tangent-space normals, each channel 0 to 1: n = 2·rgb - 1. Empty where effects.normal_map is.
  std::shared_ptr<const Image<glm::vec3>> normal_map{};
  /// Heights, linear, 0 to 1. Empty where effects.displacement_map is.
  std::shared_ptr<const Image<float>> displacement_map{};
  MeshBelief belief{};                          ///< what a solver is told instead (sim/believed.h)
  std::shared_ptr<const Mesh> believed_mesh{};  ///< empty where belief.file is
};

/// A projector: a device that emits.
struct Projector {
  Device device;
  double flux_lm =
      1000;  ///< of the all-white picture, shared evenly by the panel's pixels: Φ = flux_lm / (W·H)
  Lookup lookup = Lookup::nearest;
  Border border = Border::black;
  ProjectorEffects effects{};
  std::shared_ptr<const Image<float>> vignetting_map{};  ///< of effects.vignetting; empty where it has none
};

/// A camera: a device that measures.
struct Camera {
  Device device;
  Sensor sensor;
  Vignetting vignetting{};
  std::shared_ptr<const Image<float>> vignetting_map{};  ///< empty where `vignetting` has none
  int samples_per_pixel = 1;  ///< rays, with antialiasing, camera_defocus or diffraction
  Optics optics{};
  ColourFilter colour_filter = ColourFilter::mono;  ///< with colour
  double veiling_glare = 0;  ///< share of the light that the lens scatters over the image
  CameraBelief belief{};     ///< what a solver is told instead (sim/believed.h)
};

/// A picture of the user's that a projector shows.
struct Slide {
  Image<float> light;     ///< linear, 0 to 1
  bool is_linear = true;  ///< whether 8-bit values for it are linear too; else they follow the sRGB curve
  std::vector<Image<float>> primaries{};  ///< its red, green and blue light; empty where it is grey
};

/// How a camera sees a projector's primaries.
struct ColourMixing {
  int projector, camera;               ///< indices into the scene
  std::array<glm::dvec3, 3> channels;  ///< what red, green and blue pixels see of each primary's light
};

/// The whole scene.
struct Scene {
  std::vector<Object> objects;
  std::vector<Projector> projectors;
  std::vector<Camera> cameras;
  double ambient_lx = 0;  ///< uniform illuminance on every surface, from everywhere
  PatternParameters patterns{};
  Effects effects{};
  InterReflection inter_reflection{};
  std::shared_ptr<const Slide> slide{};  ///< where effects.slide is on
  /// Where patterns.kind is pictures, in their order; of one size and one kind of values.
  std::shared_ptr<const std::vector<Slide>> pictures{};
  glm::dvec3 pattern_colour{1, 1, 1};   ///< share of each primary's light that patterns are shown with
  std::vector<ColourMixing> mixings{};  ///< of the pairs that have one
  Timing timing{};
  bool believe_truth = false;  ///< whether a solver is told the truth, whatever the beliefs
};

}  // namespace laterna
