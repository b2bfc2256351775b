#include "render/effects/attenuation.h"

namespace laterna {

void apply_attenuation(LightMap& light, const PixelGeometry& geometry, const Projector& projector) {
  if (!projector.effects.attenuation) return;
  const glm::dvec3 k = *projector.effects.attenuation;
  const glm::dvec3 center = geometry.center(projector.device);
  weigh(light, [&](std::size_t p) {
    const double d = glm::distance(center, geometry.point(p));
    return 1 / (k.x + d * (k.y + d * k.z));
  });
}

}  // namespace laterna
