// A photograph reprojected onto a mesh's own texture.
#pragma once

#include "render/ray_scene.h"
#include "sim/image.h"
#include "sim/scene.h"

namespace laterna {

/// A texture of a mesh. Texel (x, y) is centred at s = (x + 0.5)/W, t = 1 - (y + 0.5)/H.
struct BakedTexture {
  Image<float> value;  ///< 0 where not covered
  Image<std::uint8_t>
      covered;  ///< 1 where a triangle of the mesh has the texel and the camera sees its point
};

/// Each texel's point on object `object` is looked up bilinearly in the photograph that `camera` took: the
/// camera as a slide projector, (s, t, r, q) = T·x, with its lens, shadow rays for what it does not see, and
/// no light on faces turned away. Where triangles share a texel the first one has it; texture coordinates
/// repeat. Throws InputError where the object has no texture coordinates or they repeat more than 16 times,
/// the photograph is not of the camera's size, or size_px is not 1 to 16384. Source: Segal, Korobkin et al.,
/// SIGGRAPH 1992.
BakedTexture bake_photograph(const RayScene& rays, const Scene& scene, std::uint32_t object,
                             const Camera& camera, const Image<float>& photograph, int size_px);

}  // namespace laterna
