// (s, t, r, q) at each pixel in the three ways of fixed functions.
//
//   object_linear  T·x_object,                         T = B·P·V·M
//   eye_linear     (T·eye_from_object⁻¹)·x_eye,        x_eye = eye_from_object·x_object; the planes are
//                                                      B·P·V·eye_from_world⁻¹: the same for every object
//   given          T·x_object at the vertices, by the caller; between them as a rasteriser does
//
// All are the same numbers to rounding. Source: Segal, Korobkin et al., SIGGRAPH 1992; OpenGL 2.1, 2.11.4.
#pragma once

#include "render/pixel_array.h"
#include "render/surface.h"
#include "sim/scene.h"

namespace laterna {

enum class CoordinateSource { object_linear, eye_linear, given };

/// (s, t, r, q) at each pixel of what `camera` sees; NaN where nothing is seen. Lenses are no part of it. The
/// r row is that of the projector's light planes.
PixelArray<glm::dvec4> texture_coordinates(const SurfaceMap& surface, const Scene& scene,
                                           const Camera& camera, const Projector& projector,
                                           CoordinateSource source);

}  // namespace laterna
