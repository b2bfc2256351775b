#include "tests/gl/fixed_function.h"

#include "tests/gl/context.h"
#include "tests/gl/rasteriser.h"

#include <glm/gtc/type_ptr.hpp>

#include <array>
#include <vector>

namespace laterna::gl {

namespace {

constexpr std::array<std::array<GLenum, 2>, 4> coordinates = {
    {{GL_S, GL_TEXTURE_GEN_S}, {GL_T, GL_TEXTURE_GEN_T}, {GL_R, GL_TEXTURE_GEN_R}, {GL_Q, GL_TEXTURE_GEN_Q}}};

// s, t, r and q are the rows of a matrix times the vertex.
void generate(GLint mode, GLenum planes, const glm::dmat4& rows) {
  const glm::dmat4 row = glm::transpose(rows);
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    glTexGeni(coordinates[i][0], GL_TEXTURE_GEN_MODE, mode);
    glTexGendv(coordinates[i][0], planes, glm::value_ptr(row[int(i)]));
    glEnable(coordinates[i][1]);
  }
}

// The product of a stack's factors, leftmost first; an empty list is the identity.
void load(GLenum stack, std::initializer_list<glm::dmat4> factors) {
  glMatrixMode(stack);
  glLoadIdentity();
  for (const glm::dmat4& factor : factors) glMultMatrixd(glm::value_ptr(factor));
}

struct Factors {
  glm::dmat4 b, p, v, m, eye_from_world;
};

void set_generation(Generation generation, const Factors& f) {
  const glm::dmat4 identity(1.0), bpv = f.b * f.p * f.v;
  load(GL_TEXTURE, {});
  switch (generation) {
    case Generation::object_planes:
      generate(GL_OBJECT_LINEAR, GL_OBJECT_PLANE, bpv * f.m);
      break;
    case Generation::object_stack:
      generate(GL_OBJECT_LINEAR, GL_OBJECT_PLANE, identity);
      load(GL_TEXTURE, {f.b, f.p, f.v, f.m});
      break;
    case Generation::eye_planes:
      load(GL_MODELVIEW, {f.eye_from_world});
      generate(GL_EYE_LINEAR, GL_EYE_PLANE, bpv);
      break;
    case Generation::eye_stack:
      load(GL_MODELVIEW, {});
      generate(GL_EYE_LINEAR, GL_EYE_PLANE, identity);
      load(GL_TEXTURE, {bpv * f.m * glm::inverse(f.eye_from_world * f.m)});
      break;
  }
}

}  // namespace

Image<glm::vec4> draw_fixed(const Scene& scene, GLuint slide, Generation generation) {
  const Device &camera = scene.cameras[0].device, &projector = scene.projectors[0].device;
  const Target target = make_target(camera.intrinsics.size, {GL_RGBA32F});
  begin(target);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glClampColor(GL_CLAMP_VERTEX_COLOR, GL_FALSE);
  glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FALSE);
  glEnable(GL_TEXTURE_2D);
  glBindTexture(GL_TEXTURE_2D, slide);
  glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
  load(GL_PROJECTION, {clip_from_projector(camera.intrinsics, planes_around(scene, camera))});
  for (const Object& object : scene.objects) {
    const Factors factors{texture_from_clip(),
                          clip_from_projector(projector.intrinsics, planes_around(scene, projector)),
                          projector_from_world(projector.device_from_world), object.world_from_object,
                          projector_from_world(camera.device_from_world)};
    set_generation(generation, factors);
    load(GL_MODELVIEW, {factors.eye_from_world, factors.m});
    const Triangles triangles = upload(object);
    glBindVertexArray(triangles.array);
    glDrawArrays(GL_TRIANGLES, 0, triangles.vertices);
  }
  check_errors("drawing with fixed functions");
  return read_vec4(target, 0);
}

GLuint upload_places(glm::ivec2 size) {
  Image<glm::vec4> places(size.x, size.y);
  for (int v = 0; v < size.y; ++v)
    for (int u = 0; u < size.x; ++u) places(u, v) = glm::vec4(u, v, 0, 1);
  return upload(places, Lookup::bilinear);
}

}  // namespace laterna::gl
