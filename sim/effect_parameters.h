// What the effects need to know, noun by noun. The defaults are neutral: with them an effect changes nothing.
// Each equation stands in the effect's own file under render/effects/.
#pragma once

#include "sim/lookup.h"

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <vector>

namespace laterna {

enum class VignettingModel { none, cos4, polynomial, map };

/// What share of the light the lens passes, about its optical axis or over its picture.
struct Vignetting {
  VignettingModel model = VignettingModel::none;
  std::vector<double> coefficients{};  ///< polynomial: of tan²θ, tan⁴θ, ...
  std::string map{};                   ///< map: a picture file
  bool operator==(const Vignetting&) const = default;
};

/// OpenGL's spotlight about the projector's optical axis.
struct Spotlight {
  std::optional<double> cutoff_deg{};  ///< half the cone's opening; absent: no cone
  double exponent = 0;                 ///< of cos θ
  double intensity = 1;
  bool operator==(const Spotlight&) const = default;
};

/// The electronics between the projector's input and its panel.
struct Scaler {
  std::optional<glm::ivec2> input_size{};  ///< of the pictures that come in; absent: the panel's
  double overscan = 0;                     ///< share of the input's width and height that is cut off
  /// Where the input's corners come to lie on the panel: x, y of the upper left, upper right, lower right and
  /// lower left one, from (0, 0) at the panel's upper left corner to (1, 1). Empty: the panel's corners.
  std::vector<double> keystone{};
  Lookup lookup = Lookup::bilinear;
  bool operator==(const Scaler&) const = default;
};

/// What softens a device's picture.
struct Optics {
  std::optional<double> aperture_m{};  ///< diameter of the lens's opening
  std::optional<double> focus_m{};     ///< axial depth of the plane that is sharp
  double wavelength_m = 550e-9;        ///< of the light, for diffraction
  double fill_factor = 1;              ///< share of a pixel's area, about its centre, that is active
  bool operator==(const Optics&) const = default;
};

struct ProjectorEffects {
  Vignetting vignetting{};
  Spotlight spotlight{};
  std::optional<glm::dvec3> attenuation{};  ///< constant, linear and quadratic
  Scaler scaler{};
  std::optional<double> response_exponent{};
  std::vector<double> response_table{};
  std::optional<double> black_level{};    ///< light of black over light of white
  std::optional<double> veiling_glare{};  ///< share of the light that the lens scatters over the picture
  Optics optics{};
  bool operator==(const ProjectorEffects&) const = default;
};

enum class GlossModel { none, phong, ggx };

/// A second lobe on top of Lambert's.
struct Gloss {
  GlossModel model = GlossModel::none;
  double strength = 0;                ///< reflected over incident light
  std::optional<double> exponent{};   ///< phong
  std::optional<double> roughness{};  ///< ggx: α, the slope's spread
  bool operator==(const Gloss&) const = default;
};

enum class SolidKind { none, checker, noise };

/// A procedural albedo in the mesh's own coordinates.
struct Solid {
  SolidKind kind = SolidKind::none;
  double cell = 0.1;  ///< in the mesh file's unit
  double low = 0;     ///< the factor at the darkest; 1 at the brightest
  bool operator==(const Solid&) const = default;
};

/// Which primary a camera's pixel is made for: rows of the mosaic from the image's upper left corner.
enum class ColourFilter { mono, bayer_rggb, bayer_bggr, bayer_grbg, bayer_gbrg };

/// A device that stands elsewhere from some picture on.
struct RigMove {
  std::string device{};  ///< empty: nothing moves
  int from_picture = 0;
  glm::dvec3 rotation_vector_rad{0, 0, 0}, translation{0, 0, 0};  ///< in the device's frame
  bool operator==(const RigMove&) const = default;
};

/// When pictures are shown and when they are taken. One frame of the projector is the unit of time.
struct Timing {
  std::optional<int> dropped_frame{}, repeated_frame{};
  int frames_per_pattern = 1;
  double exposure_frames = 1, exposure_delay_frames = 0, rolling_shutter_frames = 0;
  bool colour_wheel = false, bit_planes = false;
  RigMove moved{};
  bool operator==(const Timing&) const = default;
};

/// Light that goes from surface to surface before it comes to the camera.
struct InterReflection {
  int bounces = 0;  ///< the most surfaces on the way, that which the camera sees not counted
  int paths = 16;   ///< for each camera sample
  bool operator==(const InterReflection&) const = default;
};

struct MeshEffects {
  Gloss gloss{};
  Solid solid{};
  std::string normal_map{};        ///< a picture file
  std::string displacement_map{};  ///< a picture file
  double displacement = 0;         ///< where the map is white, in the mesh file's unit; signed
  double displacement_edge_px = 1;
  bool operator==(const MeshEffects&) const = default;
};

}  // namespace laterna
