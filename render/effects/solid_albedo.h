// Procedural albedo in the mesh's own coordinates. Stage: surface.
//
//   albedo ·= low + (1 - low)·s(x/cell),
//   checker: s = 1 where floor(x') + floor(y') + floor(z') is even, else 0; x' = x/cell + 1/4, so that faces
//            at whole and half cells (a box, a plane at z = 0) are on no boundary
//   noise:   s between 0 and 1: random values on the lattice of whole x/cell, blended by 3t² - 2t³ along
//            each axis
//
// x in the mesh file's unit.
#pragma once

#include "render/effects/pixel_geometry.h"

namespace laterna {

/// The factor at a point in the object's frame.
double solid_share(const Solid& solid, std::uint64_t seed, const glm::dvec3& x_object);

void apply_solid_albedo(SurfaceMap& surface, const Scene& scene);

}  // namespace laterna
