#include "tests/gl/objects.h"

#include "tests/gl/context.h"

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace laterna::gl {

namespace {

template <class T>
Image<T> rows_flipped(const Image<T>& image) {
  Image<T> flipped = image;
  for (int y = 0; y < image.height; ++y)
    std::copy_n(image.values.data() + std::size_t(y) * image.width, image.width,
                flipped.values.data() + std::size_t(image.height - 1 - y) * image.width);
  return flipped;
}

GLuint compile(GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  std::string log(4096, '\0');
  glGetShaderInfoLog(shader, GLsizei(log.size()), nullptr, log.data());
  throw std::runtime_error("shader: " + log);
}

template <class T>
GLuint upload_as(const Image<T>& slide, GLint held, GLenum format, GLenum type, Lookup lookup, GLint wrap) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  const GLint filter = lookup == Lookup::nearest ? GL_NEAREST : GL_LINEAR;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, held, slide.width, slide.height, 0, format, type,
               rows_flipped(slide).values.data());
  check_errors("the slide's upload");
  return texture;
}

template <class T>
Image<T> read_as(const Target& target, int attachment, GLenum format, GLenum type) {
  Image<T> image(target.size.x, target.size.y);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer);
  glReadBuffer(GL_COLOR_ATTACHMENT0 + attachment);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, image.width, image.height, format, type, image.values.data());
  check_errors("readback");
  return rows_flipped(image);
}

// Of the vertex array that is bound.
void set_attribute(GLuint attribute, const std::vector<glm::vec3>& values) {
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(values.size() * sizeof(glm::vec3)), values.data(), GL_STATIC_DRAW);
  glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  glEnableVertexAttribArray(attribute);
}

// An empty framebuffer, bound.
Target bound_target(glm::ivec2 size) {
  Target target{0, size};
  glGenFramebuffers(1, &target.framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  return target;
}

void check_complete() {
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("a target that OpenGL cannot draw into");
}

}  // namespace

GLuint make_program(const char* vertex, const char* fragment) {
  const GLuint program = glCreateProgram();
  glAttachShader(program, compile(GL_VERTEX_SHADER, vertex));
  glAttachShader(program, compile(GL_FRAGMENT_SHADER, fragment));
  glLinkProgram(program);
  GLint good = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (!good) throw std::runtime_error("shaders do not link");
  glUseProgram(program);
  return program;
}

void set(GLuint program, const char* name, const glm::dmat4& matrix) {
  glUniformMatrix4fv(glGetUniformLocation(program, name), 1, GL_FALSE, glm::value_ptr(glm::mat4(matrix)));
}
void set(GLuint program, const char* name, const glm::dvec2& value) {
  glUniform2f(glGetUniformLocation(program, name), float(value.x), float(value.y));
}
void set(GLuint program, const char* name, double value) {
  glUniform1f(glGetUniformLocation(program, name), float(value));
}
void set(GLuint program, const char* name, int value) {
  glUniform1i(glGetUniformLocation(program, name), value);
}

Triangles upload(const Object& object) {
  const Mesh& mesh = object.mesh;
  const glm::dmat3 normal_from_object = glm::inverseTranspose(glm::dmat3(object.world_from_object));
  std::vector<glm::vec3> positions, normals;
  for (const glm::uvec3& triangle : mesh.triangles) {
    const glm::dvec3 a = mesh.positions[triangle.x], b = mesh.positions[triangle.y],
                     c = mesh.positions[triangle.z];
    const glm::dvec3 across = glm::cross(b - a, c - a);
    if (across == glm::dvec3(0.0)) continue;
    positions.insert(positions.end(), {a, b, c});
    normals.insert(normals.end(), 3, glm::normalize(normal_from_object * glm::normalize(across)));
  }
  Triangles triangles{0, GLsizei(positions.size())};
  glGenVertexArrays(1, &triangles.array);
  glBindVertexArray(triangles.array);
  set_attribute(0, positions);
  set_attribute(1, normals);
  check_errors("the mesh's upload");
  return triangles;
}

GLuint upload(const Image<std::uint8_t>& slide, Lookup lookup, GLint wrap) {
  return upload_as(slide, GL_R8, GL_RED, GL_UNSIGNED_BYTE, lookup, wrap);
}
GLuint upload(const Image<float>& slide, Lookup lookup, GLint wrap) {
  return upload_as(slide, GL_R32F, GL_RED, GL_FLOAT, lookup, wrap);
}
GLuint upload(const Image<glm::vec4>& slide, Lookup lookup, GLint wrap) {
  return upload_as(slide, GL_RGBA32F, GL_RGBA, GL_FLOAT, lookup, wrap);
}

Target make_target(glm::ivec2 size, std::initializer_list<GLenum> colors) {
  const Target target = bound_target(size);
  const auto attach = [&](GLenum where, GLenum format) {
    GLuint picture = 0;
    glGenRenderbuffers(1, &picture);
    glBindRenderbuffer(GL_RENDERBUFFER, picture);
    glRenderbufferStorage(GL_RENDERBUFFER, format, size.x, size.y);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, where, GL_RENDERBUFFER, picture);
  };
  attach(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT32F);
  std::vector<GLenum> drawn;
  for (const GLenum format : colors) {
    drawn.push_back(GL_COLOR_ATTACHMENT0 + GLenum(drawn.size()));
    attach(drawn.back(), format);
  }
  glDrawBuffers(GLsizei(drawn.size()), drawn.data());
  check_complete();
  return target;
}

ShadowTarget make_shadow_target(int n) {
  ShadowTarget shadow{bound_target({n, n}), 0};
  glGenTextures(1, &shadow.texture);
  glBindTexture(GL_TEXTURE_2D, shadow.texture);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, n, n, 0, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, shadow.texture, 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  check_complete();
  return shadow;
}

void begin(const Target& target) {
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  glViewport(0, 0, target.size.x, target.size.y);
  glDepthMask(GL_TRUE);
  glClearColor(0, 0, 0, 0);
  glClearDepth(1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

Image<std::uint8_t> read_u8(const Target& target, int attachment) {
  return read_as<std::uint8_t>(target, attachment, GL_RED, GL_UNSIGNED_BYTE);
}
Image<float> read_float(const Target& target, int attachment) {
  return read_as<float>(target, attachment, GL_RED, GL_FLOAT);
}
Image<glm::vec4> read_vec4(const Target& target, int attachment) {
  return read_as<glm::vec4>(target, attachment, GL_RGBA, GL_FLOAT);
}

}  // namespace laterna::gl
