// The texture matrix and its four factors.
//
//   texture_from_object = texture_from_clip · clip_from_projector · projector_from_world · world_from_object
//           T           =         B         ·          P          ·           V          ·         M
//
// Column vectors, double precision. (s, t, r, q) = T·(x, y, z, 1); the lit side is q > 0, and q is the axial
// depth in metres. Everything else that a device does (lens distortion, defocus) is named apart from T. After
// Segal, Korobkin et al., "Fast Shadows and Lighting Effects Using Texture Mapping", SIGGRAPH 1992.
#pragma once

#include "sim/intrinsics.h"
#include "sim/rigid.h"

#include <glm/glm.hpp>

#include <optional>

namespace laterna {

/// Where the light begins and ends, as axial depth in metres; absent: no such plane.
struct LightPlanes {
  std::optional<double> near_m, far_m;
};

/// Throws InputError, beginning with `what`, unless 0 < near < far, both finite, where present.
void validate(const LightPlanes& planes, const char* what);

/// Only for the r row of P: the near plane that stands in for an absent one. An absent far plane lies at
/// infinity.
inline constexpr double default_near_m = 0.01;

/// B: scale and bias of s, t and r from clip [-1,1] to texture [0,1].
glm::dmat4 texture_from_clip();

/// P: OpenGL projection (eye frame x right, y up, looking along -z) with the principal point anywhere:
///   x_clip/w = 2·(u + 0.5)/W - 1,  y_clip/w = 1 - 2·(v + 0.5)/H,  w = depth,
///   with u, v of Intrinsics; z_clip/w runs from -1 at the near plane to 1 at the far plane.
glm::dmat4 clip_from_projector(const Intrinsics& intrinsics, const LightPlanes& planes = {});

/// V: OpenGL view: diag(1, -1, -1, 1)·device_from_world.
glm::dmat4 projector_from_world(const Rigid& device_from_world);

/// T down to object space, composed in double as (B·P)·(V·M), so that large world coordinates cancel before
/// anything is scaled by W or H. `world_from_object` may hold any affine map (scale included).
glm::dmat4 texture_from_object(const Intrinsics& intrinsics, const LightPlanes& planes,
                               const Rigid& device_from_world,
                               const glm::dmat4& world_from_object = glm::dmat4(1.0));

/// Texture to pixel: u = s/q·W - 0.5, v = (1 - t/q)·H - 0.5. No check of q.
glm::dvec2 pixel_from_texture(const glm::dvec4& strq, glm::ivec2 size);

/// Pixel to texture: (s/q, t/q) = ((u + 0.5)/W, 1 - (v + 0.5)/H); the inverse of pixel_from_texture.
glm::dvec2 texture_from_pixel(const glm::dvec2& pixel, glm::ivec2 size);

/// The homogeneous pixel matrix of T: (u·q, v·q, q) = A·(x, y, z, 1), given by its three rows.
glm::dmat4x3 pixel_from_object(const glm::dmat4& texture_from_object, glm::ivec2 size);

/// What decompose() finds.
struct TextureMatrixParts {
  Intrinsics intrinsics;
  Rigid device_from_world;
  double skew_px = 0;  ///< K(0,1) in pixels; 0 for a matrix that Laterna made
};

/// T, up to a positive or negative factor, back to K, R, t: RQ decomposition of the pixel matrix with fx, fy
/// > 0 and det R = 1 (Hartley and Zisserman, Multiple View Geometry, 2nd ed., 6.2.4). The r row is not used.
/// Throws InputError where the left 3×3 block is singular or not finite.
TextureMatrixParts decompose(const glm::dmat4& texture_from_world, glm::ivec2 size);

}  // namespace laterna
