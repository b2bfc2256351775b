#include "apps/lab/dataset/sight.h"

namespace laterna {

Sight sight_of(const Scene& scene, const Traced& traced, const View& view) {
  const SurfaceMap& surface = traced.surfaces[view.camera];
  const std::size_t pixels = std::size_t(surface.width) * surface.height;
  std::size_t seen = 0, lit = 0;
  for (std::size_t i = 0; i < pixels; ++i) seen += surface.hit(i), lit += view.light.lit(i);
  return {double(seen) / double(pixels), double(lit) / double(pixels),
          overlap(scene, traced, view).projector_seen / 100};
}

std::string rejection(const std::vector<Sight>& views, const RejectSettings& reject) {
  for (const Sight& view : views) {
    if (view.seen == 0) return "nothing_seen";
    if (view.lit == 0) return "no_overlap";
    if (view.lit < reject.least_lit) return "too_little_lit";
    if (view.projector < reject.least_projector) return "too_little_of_projector";
  }
  return {};
}

}  // namespace laterna
