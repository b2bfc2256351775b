// Shadows by a depth picture from the projector's seat. Source: L. Williams, "Casting curved shadows on
// curved surfaces", SIGGRAPH 1978.
#pragma once

#include "render/ray_scene.h"
#include "sim/image.h"
#include "sim/scene.h"

namespace laterna {

/// Axial depth in metres of the first surface behind the middle of each texel; infinite where there is none.
/// Texel (x, y) of n×n is centred at projector pixel ((x + 0.5)/n·W - 0.5, (y + 0.5)/n·H - 0.5).
using ShadowMap = Image<double>;

/// The projector's picture, cut into texels × texels. Its lens is left out.
ShadowMap make_shadow_map(const RayScene& rays, const Scene& scene, const Projector& projector, int texels);

/// Whether the nearest texel has nothing nearer than depth_m - bias_m. `pixel` inside the projector's picture
/// of `size`.
bool lit_by(const ShadowMap& map, const glm::dvec2& pixel, glm::ivec2 size, double depth_m, double bias_m);

}  // namespace laterna
