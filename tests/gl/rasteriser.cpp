#include "tests/gl/rasteriser.h"

#include "tests/gl/context.h"
#include "tests/gl/shaders.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <limits>
#include <numbers>

namespace laterna::gl {

LightPlanes planes_around(const Scene& scene, const Device& device) {
  double near_m = std::numeric_limits<double>::infinity(), far_m = 0;
  const WorldProjection projection(device);
  for (const Object& object : scene.objects) {
    for (const glm::dvec3& x_object : object.mesh.positions) {
      const double q = projection.project(glm::dvec3(object.world_from_object * glm::dvec4(x_object, 1))).z;
      near_m = std::min(near_m, q), far_m = std::max(far_m, q);
    }
  }
  return {std::max(0.99 * near_m, 1e-3 * far_m), 1.01 * far_m};
}

Rasteriser::Rasteriser(const Scene& scene, const RasterOptions& options)
    : scene_(scene), options_(options), projector_(scene.projectors[options.projector]) {
  const Device& camera = scene.cameras[options.camera].device;
  clip_from_world_ = clip_from_projector(camera.intrinsics, planes_around(scene, camera)) *
                     projector_from_world(camera.device_from_world);
  planes_ = planes_around(scene, projector_.device);
  for (const Object& object : scene.objects) objects_.push_back(upload(object));
  depth_program_ = make_program(vertex_shader, depth_shader);
  light_program_ = make_program(vertex_shader, light_shader);
  set(light_program_, "slide", 0);
  set(light_program_, "depth_map", 1);
  set(light_program_, "size", glm::dvec2(projector_.device.intrinsics.size));
  set(light_program_, "back_face", int(scene.effects.back_face));
  set(light_program_, "irradiance", int(scene.effects.irradiance));
  set(light_program_, "shadow", int(scene.effects.shadow));
  set(light_program_, "border",
      int(scene.effects.border && projector_.border == Border::black && !options.hardware_border));
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_DITHER);
  if (scene.effects.shadow) draw_shadow_map();
  target_ = make_target(camera.intrinsics.size, {GL_R8, GL_R32F, GL_RGBA32F});
  check_errors("the rasteriser's making");
}

template <class Prepare>
void Rasteriser::draw_objects(const Prepare& prepare) const {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const glm::dmat4& world_from_object = scene_.objects[i].world_from_object;
    glFrontFace(glm::determinant(world_from_object) > 0 ? GL_CCW : GL_CW);
    prepare(scene_.objects[i]);
    glBindVertexArray(objects_[i].array);
    glDrawArrays(GL_TRIANGLES, 0, objects_[i].vertices);
  }
}

void Rasteriser::draw_shadow_map() {
  shadow_ = make_shadow_target(options_.shadow_map_px);
  const glm::dmat4 clip_from_world = clip_from_projector(projector_.device.intrinsics, planes_) *
                                     projector_from_world(projector_.device.device_from_world);
  begin(shadow_.target);
  glUseProgram(depth_program_);
  glDepthFunc(GL_LESS);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(options_.shadow_slope, options_.shadow_steps);
  draw_objects([&](const Object& object) {
    set(depth_program_, "clip_from_object", clip_from_world * object.world_from_object);
  });
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void Rasteriser::draw_depth(const Target& target) {
  begin(target);
  glUseProgram(depth_program_);
  glDepthFunc(GL_LESS);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);  // a shader without outputs would leave anything there
  draw_objects([&](const Object& object) {
    set(depth_program_, "clip_from_object", clip_from_world_ * object.world_from_object);
  });
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void Rasteriser::draw_light(GLuint slide, double saturation_cd_per_m2) {
  const Intrinsics& k = projector_.device.intrinsics;
  const double at_1_m = projector_.flux_lm / (double(k.size.x) * k.size.y) * k.fx * k.fy;
  const glm::dmat4 ray_from_world =
      glm::translate(glm::dmat4(1.0), -center_in_world(projector_.device.device_from_world));
  glUseProgram(light_program_);
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, shadow_.texture);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, slide);
  draw_objects([&](const Object& object) {
    const glm::dmat4& m = object.world_from_object;
    set(light_program_, "clip_from_object", clip_from_world_ * m);
    set(light_program_, "texture_from_object",
        options_.texture_from_texture *
            texture_from_object(k, planes_, projector_.device.device_from_world, m));
    set(light_program_, "ray_from_object", ray_from_world * m);
    set(light_program_, "gain", object.albedo / std::numbers::pi * at_1_m / saturation_cd_per_m2);
  });
  check_errors("drawing");
}

RasterPicture Rasteriser::picture_of(GLuint slide, double saturation_cd_per_m2) {
  draw_depth(target_);
  draw_light(slide, saturation_cd_per_m2);
  return {read_u8(target_, 0), read_float(target_, 1), read_vec4(target_, 2)};
}

RasterPicture Rasteriser::picture(const Image<std::uint8_t>& slide, double saturation_cd_per_m2) {
  return picture_of(
      upload(slide, projector_.lookup, options_.hardware_border ? GL_CLAMP_TO_BORDER : GL_CLAMP_TO_EDGE),
      saturation_cd_per_m2);
}

RasterPicture Rasteriser::picture(const Image<float>& slide, double saturation_cd_per_m2) {
  return picture_of(
      upload(slide, projector_.lookup, options_.hardware_border ? GL_CLAMP_TO_BORDER : GL_CLAMP_TO_EDGE),
      saturation_cd_per_m2);
}

}  // namespace laterna::gl
