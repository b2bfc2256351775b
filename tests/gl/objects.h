// What OpenGL holds: programs, triangles, slides, targets. All are bare names that go with the context.
//
// Two conventions differ from ours, and are turned around here and nowhere else:
//   rows      OpenGL's first row is the lowest (t and window y point up), ours the highest: rows are flipped
//   at
//             upload and at readback, so that T's t row needs no flip of its own
//   numbers   matrices go from double to float, once, as whole products
// What agrees: GLM and OpenGL both hold column vectors' matrices column by column, so nothing is transposed;
// and our texture coordinates span the picture from edge to edge, as OpenGL's do.
#pragma once

#include "sim/image.h"
#include "sim/lookup.h"
#include "sim/scene.h"
#include "tests/gl/opengl.h"

#include <glm/glm.hpp>

namespace laterna::gl {

/// Compiles and links; uses it. Throws std::runtime_error with OpenGL's log where that fails.
GLuint make_program(const char* vertex, const char* fragment);

/// Sets a uniform of a program in use. A name that the program does not use is ignored.
void set(GLuint program, const char* name, const glm::dmat4& matrix);
void set(GLuint program, const char* name, const glm::dvec2& value);
void set(GLuint program, const char* name, double value);
void set(GLuint program, const char* name, int value);

/// An object's triangles, three vertices each: attribute 0 the position in the object's frame, 1 the
/// triangle's unit normal in the world, towards its front side (which moves with the object, also when
/// world_from_object mirrors it).
struct Triangles {
  GLuint array = 0;
  GLsizei vertices = 0;
};
Triangles upload(const Object& object);

/// A picture as a texture: 8 bits, or floats, of which OpenGL promises a finer bilinear weight.
/// Beyond the edge: `wrap`, with a border colour of 0.
GLuint upload(const Image<std::uint8_t>& slide, Lookup lookup, GLint wrap = GL_CLAMP_TO_EDGE);
GLuint upload(const Image<float>& slide, Lookup lookup, GLint wrap = GL_CLAMP_TO_EDGE);
GLuint upload(const Image<glm::vec4>& slide, Lookup lookup, GLint wrap = GL_CLAMP_TO_EDGE);

/// Pictures to draw into, off screen.
struct Target {
  GLuint framebuffer = 0;
  glm::ivec2 size{0, 0};
};

/// `colors`: the formats of attachments 0, 1, … ; and depth in 32-bit floats.
Target make_target(glm::ivec2 size, std::initializer_list<GLenum> colors);

/// A depth picture of n×n texels that a sampler2DShadow compares r/q with: 1 where r/q ≤ depth at the nearest
/// texel.
struct ShadowTarget {
  Target target;
  GLuint texture = 0;
};
ShadowTarget make_shadow_target(int n);

/// Draws into a target from now on, all of it, after clearing it to 0 and depth 1.
void begin(const Target& target);

/// A target's pictures, the highest row first.
Image<std::uint8_t> read_u8(const Target& target, int attachment);
Image<float> read_float(const Target& target, int attachment);
Image<glm::vec4> read_vec4(const Target& target, int attachment);

}  // namespace laterna::gl
