// The projective texture at one point: where the point falls in a projector's picture, and why it is dark if
// it is.
//
// (s, t, r, q) = T·x and the divide give the pinhole pixel; the lens warps it. After Segal, Korobkin et al.,
// "Fast Shadows and Lighting Effects Using Texture Mapping", SIGGRAPH 1992.
#pragma once

#include "sim/scene.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace laterna {

/// Why a point gets no light from a projector. The first that holds, in this order (`no_surface` aside).
enum class Unlit : std::uint8_t {
  lit,          ///< it does get light
  behind,       ///< q ≤ 0: not in front of the projector
  before_near,  ///< q < near
  beyond_far,   ///< q > far
  lens,         ///< beyond the lens's fold, or the model fails
  outside,      ///< beyond the picture's edge, with Border::black
  back_face,    ///< the projector, or the camera, is not on the surface's front side
  shadow,       ///< something stands between
  no_surface,   ///< the camera's pixel sees nothing
  cutoff,       ///< beyond the cone of the spotlight; after all others
};

/// Where a point falls.
struct ProjectedPoint {
  double u_px, v_px;            ///< projector pixel, with the lens; NaN where behind, or the lens fails
  double depth_m;               ///< q
  double pixels_per_unit_area;  ///< det ∂(u,v)/∂(x/z, y/z), in px²; only where lit
  Unlit why;                    ///< lit, or one of the reasons down to `outside`
};

/// What divide() needs beside the lens: (u·q, v·q, q) of the pinhole are u, v and q times (x, 1).
struct LookupTerms {
  double u[4], v[4], q[4];
  double near_m, far_m, width, height;
  double pinhole_area;  ///< fx·fy
  bool clamp;           ///< Border::clamp
};

/// A projector seen from one object's frame. Immutable, safe to share among threads.
class ProjectiveLookup {
 public:
  /// Composes T in double down to object space: texture_from_object of sim/texture_matrix.h.
  ProjectiveLookup(const Projector& projector, const glm::dmat4& world_from_object = glm::dmat4(1.0));

  /// (u·q, v·q, q) without the lens: linear in x, so that interpolating it between vertices is the same as
  /// evaluating it at the point between them.
  glm::dvec3 homogeneous_pixel(const glm::dvec3& x_object) const {
    const double x = x_object.x, y = x_object.y, z = x_object.z;
    const auto along = [&](const double(&t)[4]) { return t[0] * x + t[1] * y + t[2] * z + t[3]; };
    return {along(terms_.u), along(terms_.v), along(terms_.q)};
  }

  /// The divide, the lens, the light planes and the border. Lit where near ≤ q ≤ far and, with Border::black,
  /// -0.5 ≤ u < W-0.5 and -0.5 ≤ v < H-0.5: the light ends at the image's edge. With Border::clamp it goes
  /// on.
  ProjectedPoint divide(const glm::dvec3& uq_vq_q) const {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const double q = uq_vq_q.z;
    if (!(q > 0)) return {nan, nan, q, 0, Unlit::behind};
    const double inverse_q = 1 / q;
    ProjectedPoint point{uq_vq_q.x * inverse_q, uq_vq_q.y * inverse_q, q, terms_.pinhole_area, Unlit::lit};
    if (!pinhole_ && !warp(point)) return {nan, nan, q, 0, Unlit::lens};
    const bool inside = point.u_px >= -0.5 && point.u_px < terms_.width - 0.5 && point.v_px >= -0.5 &&
                        point.v_px < terms_.height - 0.5;
    if (!inside && !terms_.clamp) point.why = Unlit::outside;
    if (q > terms_.far_m) point.why = Unlit::beyond_far;
    if (q < terms_.near_m) point.why = Unlit::before_near;
    return point;
  }

  ProjectedPoint project(const glm::dvec3& x_object) const { return divide(homogeneous_pixel(x_object)); }

  /// The same for many points at once: the terms, then, unless it is a pinhole, each point's warp.
  const LookupTerms& terms() const { return terms_; }
  bool is_pinhole() const { return pinhole_; }

  /// From the pinhole's u_px and v_px to the lens's, and its pixels_per_unit_area; false where the lens
  /// fails.
  bool warp(ProjectedPoint& point) const;

 private:
  LookupTerms terms_;
  bool pinhole_;
  LensProjection lens_;
};

/// The texel whose box holds a pixel position, floor(u + 0.5), clamped to the picture. Its index along one
/// axis.
inline int nearest_texel(double u, int size) {
  return static_cast<int>(std::clamp(u + 0.5, 0.0, double(size - 1)));
}

/// The two texels between whose centres a position lies along one axis, and the second one's share. Half a
/// pixel from the edge and beyond, both are the edge texel.
struct LinearTaps {
  int first, second;
  double share;  ///< of `second`, in [0, 1)
};

inline LinearTaps linear_taps(double u, int size) {
  const double inside = std::clamp(u, 0.0, double(size - 1));
  const int first = static_cast<int>(inside);
  return {first, std::min(first + 1, size - 1), inside - first};
}

}  // namespace laterna
