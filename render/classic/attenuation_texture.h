// Distance attenuation as a 3D texture over (s, t, r).
//
// Under a perspective P, r/q is hyperbolic in the axial depth q: with near n and far f
//   r/q = f/(f - n)·(1 - n/q),   q = n·f/(f - r/q·(f - n)).
// A texture filled as if r/q were the share of the way from near to far answers with the light of another
// depth. Source: the course book's spotlight; OpenGL 2.1 specification, 2.14.1.
#pragma once

#include "sim/scene.h"

#include <glm/glm.hpp>

#include <vector>

namespace laterna {

/// What a texel at r/q stands for.
enum class DepthIndex {
  hyperbolic,  ///< the depth that P gives this r/q: right
  linear       ///< near + r/q·(far - near): the naive reading
};

/// Axial depth in metres at r/q in [0, 1].
double depth_at(double r_over_q, double near_m, double far_m, DepthIndex index);

/// Texel (i, j, k) is centred at s = (i + 0.5)/size.x, t = (j + 0.5)/size.y, r = (k + 0.5)/size.z.
struct AttenuationTexture {
  glm::ivec3 size{0, 0, 0};
  std::vector<float> values;

  /// Trilinear at (s, t, r)/q; beyond the outermost texels' centres, theirs (clamp to edge).
  double value(const glm::dvec3& str_over_q) const;
};

/// 1/(k0 + k1·d + k2·d²) of the projector's attenuation, d the distance of the texel's point from its centre.
/// Throws InputError where the projector lacks near, far or attenuation.
AttenuationTexture attenuation_texture(const Projector& projector, glm::ivec3 size,
                                       DepthIndex index = DepthIndex::hyperbolic);

/// The factor itself at a distance.
double attenuation_at(const Projector& projector, double distance_m);

}  // namespace laterna
