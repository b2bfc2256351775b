// Projective texture as it was drawn before shaders: OpenGL generates the coordinates, from planes and a
// stack of texture matrices.
#pragma once

#include "sim/image.h"
#include "sim/scene.h"
#include "tests/gl/objects.h"

namespace laterna::gl {

/// Four ways to the same (s, t, r, q). M: world_from_object; E: eye_from_world of the camera, OpenGL's eye
/// frame. OpenGL multiplies the planes of GL_EYE_LINEAR by the inverse of the model view that is current when
/// they are given.
enum class Generation {
  object_planes,  ///< GL_OBJECT_LINEAR, planes: the rows of T = B·P·V·M
  object_stack,  ///< GL_OBJECT_LINEAR, planes: the identity; texture matrix: B·P·V·M, pushed factor by factor
  eye_planes,  ///< GL_EYE_LINEAR, planes: the rows of B·P·V, given while the model view is E
  eye_stack    ///< GL_EYE_LINEAR, planes: the identity, given while the model view is the identity; texture
               ///< matrix: T·(E·M)⁻¹
};

/// The picture of a scene without light planes, as Rasteriser's with `back_face`, `irradiance` and `shadow`
/// off, but for what fixed functions lack: nothing is discarded, and what is outside, or where q ≤ 0, shows
/// what the texture's wrapping makes of it. Four channels, unclamped. A context with Profile::compatibility
/// must be current.
Image<glm::vec4> draw_fixed(const Scene& scene, GLuint slide, Generation generation);

/// A slide whose texels tell their place, (u, v, 0, 1), read bilinearly: what it shows is u and v, as far as
/// the outermost texels' centres.
GLuint upload_places(glm::ivec2 size);

}  // namespace laterna::gl
