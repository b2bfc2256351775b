// Where a camera's picture jumps from one surface to another.
#pragma once

#include "render/surface.h"
#include "sim/image.h"

namespace laterna::gl {

/// 1 at pixels that have such a jump among the pairs of neighbours in their 3×3 pixels. A pair is joined
/// where both see nothing, or triangles of one mesh that share a vertex, or where the planes of their two
/// triangles meet between the two pixels (1/depth of a plane is linear over the picture), or are one plane
/// within 1e-6 of the depth. Slivers between two pixels count as jumps.
Image<std::uint8_t> near_jumps(const Scene& scene, const RayScene& rays, const SurfaceMap& surface);

}  // namespace laterna::gl
