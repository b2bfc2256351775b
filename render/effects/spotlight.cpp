#include "render/effects/spotlight.h"

#include <cmath>
#include <numbers>

namespace laterna {

void apply_spotlight(LightMap& light, const PixelGeometry& geometry, const Projector& projector) {
  const Spotlight& spot = projector.effects.spotlight;
  if (spot == Spotlight{}) return;
  const double least_cos = spot.cutoff_deg ? std::cos(*spot.cutoff_deg * std::numbers::pi / 180) : 0;
  weigh(light, [&](std::size_t p) {
    const glm::dvec3 x = geometry.in_device(projector.device, p);
    const double cos_theta = x.z / glm::length(x);
    if (cos_theta >= least_cos) return spot.intensity * std::pow(cos_theta, spot.exponent);
    light.why.values[p] = std::uint8_t(Unlit::cutoff);
    return 0.0;
  });
}

}  // namespace laterna
