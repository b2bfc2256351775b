// The four passes of the 1992 demo as a program of its time drew them: fixed functions, immediate mode.
#pragma once

#include "sim/pattern.h"
#include "sim/scene.h"
#include "tests/gl/context.h"
#include "tests/gl/objects.h"
#include "tests/gl/rasteriser.h"

#include <glm/gtc/type_ptr.hpp>

#include <numbers>

namespace laterna::gl {

struct PassPicture {
  Image<float> share;  ///< 8 bits, 0 to 1
  double white;        ///< the luminance in cd/m² that 1 stands for
};

/// A face whose triangles turn from the projector gets no light: the caller's test, per triangle.
inline bool faces(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& light) {
  return glm::dot(glm::cross(b - a, c - a), light - a) > 0;
}

/// Vertices of an object in the world, with (s, t) of its own texture or T·x of the projector, by the caller.
inline void draw_object(const Object& object, const glm::dmat4* texture_from_world, const glm::dvec3* light) {
  glBegin(GL_TRIANGLES);
  for (const glm::uvec3& triangle : object.mesh.triangles) {
    std::array<glm::dvec3, 3> x{};
    for (int i = 0; i < 3; ++i)
      x[std::size_t(i)] = object.world_from_object * glm::dvec4(object.mesh.positions[triangle[i]], 1);
    if (light != nullptr && !faces(x[0], x[1], x[2], *light)) continue;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3& at = x[std::size_t(i)];
      if (texture_from_world != nullptr)
        glTexCoord4dv(glm::value_ptr(*texture_from_world * glm::dvec4(at, 1)));
      else
        glTexCoord2dv(glm::value_ptr(object.mesh.texture_coordinates[triangle[i]]));
      glVertex3dv(glm::value_ptr(at));
    }
  }
  glEnd();
}

/// Ambient + depth, add light where depth is equal, depth again, multiply by the surface's texture. The scene
/// has one albedo, no irradiance, no shadow; a context with Profile::compatibility must be current.
inline PassPicture draw_four_passes(const Scene& scene, const PatternStack& slide) {
  const Device& camera = scene.cameras[0].device;
  const Projector& projector = scene.projectors[0];
  const Intrinsics& k = projector.device.intrinsics;
  const double light_lx = projector.flux_lm / (double(k.size.x) * k.size.y) * k.fx * k.fy;
  const double full_lx = light_lx + scene.ambient_lx;
  const Target target = make_target(camera.intrinsics.size, {GL_RGBA8});
  begin(target);
  glMatrixMode(GL_PROJECTION);
  glLoadMatrixd(glm::value_ptr(clip_from_projector(camera.intrinsics, planes_around(scene, camera)) *
                               projector_from_world(camera.device_from_world)));
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  const double ambient = scene.ambient_lx / full_lx, share = light_lx / full_lx;
  glColor3d(ambient, ambient, ambient);
  for (const Object& object : scene.objects) draw_object(object, nullptr, nullptr);

  Image<std::uint8_t> values(slide.width, slide.height);
  std::copy(slide.values.begin(), slide.values.end(), values.values.begin());
  glEnable(GL_TEXTURE_2D);
  glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
  glBindTexture(GL_TEXTURE_2D, upload(values, projector.lookup, GL_CLAMP_TO_BORDER));
  glDepthFunc(GL_EQUAL);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glColor3d(share, share, share);
  const glm::dmat4 texture = texture_from_world(projector.device);
  const glm::dvec3 center = center_in_world(projector.device.device_from_world);
  for (const Object& object : scene.objects) draw_object(object, &texture, &center);

  glDisable(GL_TEXTURE_2D);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDepthFunc(GL_LESS);
  glClear(GL_DEPTH_BUFFER_BIT);
  for (const Object& object : scene.objects) draw_object(object, nullptr, nullptr);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);

  glEnable(GL_TEXTURE_2D);
  glDepthFunc(GL_EQUAL);
  glBlendFunc(GL_DST_COLOR, GL_ZERO);
  glColor3d(1, 1, 1);
  for (const Object& object : scene.objects) {
    if (!object.albedo_map) continue;
    glBindTexture(GL_TEXTURE_2D, upload(*object.albedo_map, Lookup::bilinear, GL_REPEAT));
    draw_object(object, nullptr, nullptr);
  }
  check_errors("four passes");
  const Image<std::uint8_t> dn = read_u8(target, 0);
  PassPicture picture{Image<float>(dn.width, dn.height),
                      scene.objects[0].albedo * full_lx / std::numbers::pi};
  for (std::size_t p = 0; p < dn.values.size(); ++p) picture.share.values[p] = float(dn.values[p]) / 255;
  return picture;
}

}  // namespace laterna::gl
