// Whether what the effects need is there and makes sense.
#pragma once

#include "sim/scene_spec.h"

namespace laterna {

/// Each throws InputError with a sentence that begins with the key at fault.
void check(const Vignetting& vignetting);     ///< polynomial: coefficients; map: a file
void check(const Scaler& scaler);             ///< keystone: 8 numbers, corners of a convex quadrilateral
void check(const ProjectorEffects& effects);  ///< these two, the response, the attenuation
void check(const MeshEffects& effects, double albedo);  ///< the gloss; displacement and its map go together
void check(const Gloss& gloss, double albedo);          ///< what its model needs; albedo + strength ≤ 1

/// A switch that is on has what it needs on at least one noun; a slide's switch, kind and file go together;
/// inter-reflection has bounces, and rows that fit in memory. Throws InputError that names the missing key.
void check_effects(const SceneSpec& scene);

/// Devices that [[colour]] and [timing] name exist, and no pair has two mixings. `named` has passed
/// with_names().
void check_references(const SceneSpec& named);

/// The quadrilateral of a scaler, upper left corner first; the panel's corners where no keystone is given.
std::array<glm::dvec2, 4> keystone_corners(const Scaler& scaler);

}  // namespace laterna
