#include "render/exposure.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace laterna {

Exposure make_exposure(const Sensor& sensor, double saturation_cd_per_m2, const NoiseKey& noise) {
  const double saturation = sensor.saturation_cd_per_m2.value_or(saturation_cd_per_m2);
  if (sensor.bit_depth < 8 || sensor.bit_depth > 16)
    throw InputError(fmt::format("sensor: bit_depth is {}, expected 8 to 16", sensor.bit_depth));
  if (!(sensor.noise_sigma_dn >= 0 && std::isfinite(sensor.noise_sigma_dn)))
    throw InputError(fmt::format("sensor: noise_sigma_dn is {}, expected 0 or more", sensor.noise_sigma_dn));
  if (!(saturation > 0 && std::isfinite(saturation)))
    throw InputError(
        fmt::format("sensor: saturation_cd_per_m2 is {}, expected a positive number", saturation));
  return {sensor.bit_depth, saturation, sensor.noise_sigma_dn, noise};
}

double automatic_saturation_cd_per_m2(const SurfaceMap& surface, std::span<const LightMap> lights,
                                      double ambient_lx) {
  constexpr double percentile = 0.999, share_of_scale = 0.8;
  const std::size_t pixels = surface.albedo.values.size();
  std::vector<double> seen;
  for (const LightMap& light : lights) {
    for (std::size_t p = 0; p < pixels; ++p) {
      if (light.lit(p))
        seen.push_back(luminance_cd_per_m2(surface.albedo.values[p], light.white_lx.values[p], ambient_lx));
    }
  }
  const bool dark = seen.empty();
  for (std::size_t p = 0; dark && ambient_lx > 0 && p < pixels; ++p) {
    if (surface.hit(p)) seen.push_back(luminance_cd_per_m2(surface.albedo.values[p], 0, ambient_lx));
  }
  if (seen.empty()) return 1;
  const auto rank = static_cast<std::size_t>(std::ceil(percentile * double(seen.size())));
  const auto at = seen.begin() + std::ptrdiff_t(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(seen.begin(), at, seen.end());
  return *at > 0 ? *at / share_of_scale : 1;
}

}  // namespace laterna
