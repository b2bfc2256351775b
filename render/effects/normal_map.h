// Normal map. Stage: weight.
//
//   n' = normalise(x·T + y·B + z·N),  (x, y, z) = 2·rgb - 1,
//
// N the flat triangle's unit normal, T the unit vector in its plane along which the texture coordinate s
// grows, B the one perpendicular to N and T on the side of growing t; rgb is looked up bilinearly, repeated.
// The irradiance E ∝ cos(θ_i) becomes E·max(0, n'·l)/(n·l), l towards the projector. Shadow, back face and
// silhouette stay those of the flat triangle. With the irradiance off there is no cosine to replace: nothing
// changes (gloss still uses n').
#pragma once

#include "render/effects/pixel_geometry.h"

namespace laterna {

/// n' at a point of a triangle, in the object's frame; `normal_world` is N. Where the texture coordinates of
/// the triangle are degenerate, N itself. The object must have a normal map.
glm::dvec3 mapped_normal(const Object& object, std::uint32_t triangle, const glm::dvec3& x_object,
                         const glm::dvec3& normal_world);

void apply_normal_map(LightMap& light, const PixelGeometry& geometry, const Projector& projector);

}  // namespace laterna
