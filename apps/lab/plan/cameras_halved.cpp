#include "apps/lab/plan/choices.h"
#include "sim/device_spec.h"
#include "sim/resample.h"

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

// A camera model's file as numbers of the scene file.
void take_from_file(DeviceSpec& spec, const std::filesystem::path& folder) {
  const Device device = device_of(spec, folder, "[[camera]]");
  const Intrinsics& k = device.intrinsics;
  spec.cameramodel.clear();
  spec.size = k.size, spec.fx = k.fx, spec.fy = k.fy, spec.cx = k.cx, spec.cy = k.cy;
  spec.lens = device.lens;
  spec.device_from_world = rows_of(device.device_from_world);
}

void resample(CameraSpec& camera, double scale) {
  DeviceSpec& spec = camera.device;
  const glm::ivec2 size = spec.size.value();
  const Intrinsics less =
      resampled({size, spec.fx.value_or(1), spec.fy.value_or(1), spec.cx.value_or((size.x - 1) / 2.0),
                 spec.cy.value_or((size.y - 1) / 2.0)},
                scale);
  spec.size = less.size;  // angles of view and throw ratios are of the whole picture
  if (spec.fy) spec.fy = less.fy;
  if (spec.fx) spec.fx = less.fx, spec.cx = less.cx, spec.cy = less.cy;
  CameraBelief& b = camera.believed;
  for (glm::dvec2* px : {&b.focal_px, &b.center_px, &b.sigma_focal_px, &b.sigma_center_px}) *px *= scale;
}

}  // namespace

SceneSpec with_cameras_halved(SceneSpec spec, int halvings, const std::filesystem::path& folder) {
  if (halvings == 0) return spec;
  for (CameraSpec& camera : spec.cameras) {
    if (!camera.device.cameramodel.empty()) take_from_file(camera.device, folder);
    resample(camera, std::ldexp(1.0, -halvings));
  }
  return spec;
}

int longest_side_px(const Scene& scene) {
  int side = 0;
  for (const Camera& camera : scene.cameras)
    side = std::max({side, camera.device.intrinsics.size.x, camera.device.intrinsics.size.y});
  return side;
}

}  // namespace laterna
