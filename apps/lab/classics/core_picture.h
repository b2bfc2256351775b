// What the core makes of a classic's scene: the picture that the classic techniques are compared with.
#pragma once

#include "render/direct_light.h"
#include "render/ray_scene.h"
#include "render/surface.h"
#include "sim/image.h"
#include "sim/pattern.h"
#include "sim/scene.h"

#include <vector>

namespace laterna {

/// The first camera's surface and each projector's light on it, with every effect of the scene that needs one
/// ray for a pixel. `scene` must outlive it. Throws InputError where the scene has no projector or no camera.
struct CoreView {
  const Scene& scene;
  RayScene rays;
  SurfaceMap surface;
  std::vector<LightMap> lights;

  explicit CoreView(const Scene& scene_to_see);
};

/// The first picture that a projector's panel shows; all white where the scene has no slide.
PatternStack slide_of(const Scene& scene, int projector = 0);

/// The share of a projector's white that `slide` shows at each pixel of a light map, as the projector's
/// lookup finds it; 0 where the pixel is dark.
Image<float> slide_light(const LightMap& light, const PatternStack& slide, Lookup lookup);

/// The luminance of the scene's picture in cd/m², by the rows of light: constant light once, and the slide of
/// every projector.
Image<float> core_picture(const CoreView& view);

}  // namespace laterna
