// Where a depth map of n×n texels cannot tell light from shadow.
#pragma once

#include "render/direct_light.h"
#include "sim/image.h"

namespace laterna::gl {

/// 1 at camera pixels whose projector pixel lies within `reach_px` (projector pixels each way) of an edge
/// between light and shadow in our own picture: of a pair of neighbours that both see a surface within the
/// projector's picture, one lit and one not. A texel of the map reaches W/n and H/n.
Image<std::uint8_t> near_shadow_edges(const Scene& scene, const LightMap& light, const glm::dvec2& reach_px);

}  // namespace laterna::gl
