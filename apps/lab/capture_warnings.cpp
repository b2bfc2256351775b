#include "apps/lab/capture_warnings.h"

#include "render/effects/projector_defocus.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr int every_strip = 8;
constexpr double finest_stripe_px = 2;  // in a reflected code bit 0 changes every other pixel

double median_footprint_px(const Scene& scene, const SceneRays& rig, int camera, int projector) {
  const StripTracer tracer(scene, rig, camera, projector);
  std::vector<float> footprints;
  for (int row = 0; row < tracer.count(); row += every_strip) {
    const LightMap light = tracer.trace(row).light;
    for (std::size_t p = 0; p < light.why.values.size(); ++p)
      if (light.lit(p)) footprints.push_back(light.footprint(p));
  }
  if (footprints.empty()) return 0;
  const auto middle = footprints.begin() + std::ptrdiff_t(footprints.size() / 2);
  std::nth_element(footprints.begin(), middle, footprints.end());
  return *middle;
}

}  // namespace

std::vector<std::string> capture_warnings(const Scene& scene, const SceneRays& rig) {
  std::vector<std::string> warnings;
  if (!scene.effects.projector_defocus || scene.effects.slide) return warnings;
  for (int camera = 0; camera < int(scene.cameras.size()); ++camera) {
    for (int projector = 0; projector < int(scene.projectors.size()); ++projector) {
      const double blur_px = median_footprint_px(scene, rig, camera, projector);
      if (blur_px <= finest_stripe_px) continue;
      const double kept = std::max(0.0, stripe_contrast(blur_px, finest_stripe_px));
      warnings.push_back(fmt::format(
          "warning: \"{}\" is out of focus where \"{}\" sees it: a blur of {:.1f} px (median) leaves the "
          "finest Gray stripes, {} px wide, {:.0f} % of their contrast{}",
          scene.projectors[projector].device.name, scene.cameras[camera].device.name, blur_px,
          finest_stripe_px, 100 * kept, kept < 0.1 ? ": they will not decode" : ""));
    }
  }
  return warnings;
}

}  // namespace laterna
