#include "render/effects/projector_defocus.h"

#include <cmath>
#include <numbers>

namespace laterna {

double blur_diameter_px(const Optics& optics, const Intrinsics& k, double depth_m) {
  if (!optics.aperture_m || !optics.focus_m) return 0;
  return std::sqrt(k.fx * k.fy) * *optics.aperture_m * std::abs(1 / *optics.focus_m - 1 / depth_m);
}

void apply_projector_defocus(LightMap& light, const PixelGeometry& geometry, const Projector& projector) {
  light.footprint_px = PixelArray<float>(light.width, light.height);
  const Device& device = projector.device;
  parallel_for(std::size_t(light.height), [&](std::size_t y) {
    for (std::size_t p = y * light.width; p < (y + 1) * light.width; ++p) {
      const double diameter = light.lit(p) ? blur_diameter_px(projector.effects.optics, device.intrinsics,
                                                              geometry.in_device(device, p).z)
                                           : 0;
      light.footprint_px.values[p] = static_cast<float>(diameter);
    }
  });
}

double stripe_contrast(double diameter_px, double stripe_px) {
  const double x = std::numbers::pi * diameter_px / (2 * stripe_px);
  return x > 0 ? 2 * std::cyl_bessel_j(1, x) / x : 1;
}

}  // namespace laterna
