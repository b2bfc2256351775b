// A scene's picture as OpenGL's shaders draw it: what Laterna's own pictures are compared with.
//
//   pass 1   the depth of everything, so that what is discarded later still hides what lies behind
//   pass 2   light where the depth is equal: (s, t, r, q) = T·x per vertex, interpolated by the rasteriser;
//            textureProj per fragment; discarded where q ≤ 0 and outside [0, 1]
//
// The camera's intrinsics become the projection of the picture: with sim's P, window x - 0.5 is camera pixel
// u. It follows the scene's switches `back_face`, `irradiance`, `border` and `shadow` (by a depth map), and
// knows nothing of lenses, effects and textures of meshes.
#pragma once

#include "sim/image.h"
#include "sim/scene.h"
#include "tests/gl/objects.h"

#include <vector>

namespace laterna::gl {

struct RasterOptions {
  int camera = 0, projector = 0;  ///< indices into the scene
  bool hardware_border = false;   ///< GL_CLAMP_TO_BORDER, and nothing is discarded outside
  int shadow_map_px = 1024;       ///< n of n×n, where the scene has shadows
  float shadow_slope = 2;         ///< glPolygonOffset's factor: depth per texel that is held for lit
  float shadow_steps = 4;         ///< and its units
  glm::dmat4 texture_from_texture{
      1.0};  ///< of another habit: comes after T; the size of the step is the caller\'s
};

/// Axial depths in metres that hold everything that the scene's meshes put before a device, with 1 % to
/// spare; the near one at least 1e-3 of the far one.
LightPlanes planes_around(const Scene& scene, const Device& device);

struct RasterPicture {
  Image<std::uint8_t> dn;  ///< 255 where luminance is saturation_cd_per_m2
  Image<float> share;      ///< the same before it is rounded, 0 to 1 and beyond
  Image<glm::vec4> uvq1;   ///< projector pixel u and v, depth q, and 1 where lit; all 0 where not
};

/// A scene at OpenGL. What it was made from must outlive it; a Context must be current.
class Rasteriser {
 public:
  explicit Rasteriser(const Scene& scene, const RasterOptions& options = {});

  /// Both passes and the readback. The slide's type is the texture's.
  RasterPicture picture(const Image<std::uint8_t>& slide, double saturation_cd_per_m2);
  RasterPicture picture(const Image<float>& slide, double saturation_cd_per_m2);

  /// Single steps. Pass 1 into `target`; then pass 2 for as many slides as wanted.
  void draw_depth(const Target& target);
  void draw_light(GLuint slide, double saturation_cd_per_m2);

 private:
  RasterPicture picture_of(GLuint slide, double saturation_cd_per_m2);
  void draw_shadow_map();
  template <class Prepare>
  void draw_objects(const Prepare& prepare) const;

  const Scene& scene_;
  RasterOptions options_;
  const Projector& projector_;
  glm::dmat4 clip_from_world_;  ///< the camera's P·V
  LightPlanes planes_;          ///< the projector's, of T's r row
  std::vector<Triangles> objects_;
  GLuint depth_program_, light_program_;
  ShadowTarget shadow_{};
  Target target_;
};

}  // namespace laterna::gl
