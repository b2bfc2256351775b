// From light to digital numbers: the ideal sensor, and the exposure that suits a scene.
#pragma once

#include "render/direct_light.h"
#include "render/noise.h"
#include "render/surface.h"
#include "sim/scene.h"

#include <numbers>
#include <span>

namespace laterna {

/// L = albedo/π·(E + ambient), in cd/m²: a Lambertian surface under E lx from the projector and ambient_lx
/// from everywhere.
inline double luminance_cd_per_m2(double albedo, double illuminance_lx, double ambient_lx) {
  return albedo / std::numbers::pi * (illuminance_lx + ambient_lx);
}

/// DN = round(full_scale·L/saturation + noise), halves up, clamped to [0, full_scale].
struct Exposure {
  int bit_depth = 8;  ///< 8 to 16
  double saturation_cd_per_m2 = 1;
  double noise_sigma_dn = 0;
  NoiseKey noise;

  int full_scale() const { return (1 << bit_depth) - 1; }
};

/// The sensor's exposure; `saturation_cd_per_m2` stands in where the sensor names none. Throws InputError
/// where the bit depth is outside 8..16, the noise is negative or the saturation not positive, or either is
/// not finite.
Exposure make_exposure(const Sensor& sensor, double saturation_cd_per_m2, const NoiseKey& noise);

/// The luminance that fills the scale so that the 99.9th percentile of the ideal white frame stands at 80 %
/// of it. The percentile (nearest rank: the ⌈0.999·n⌉-th smallest) is over all pixels of the camera that see
/// a lit surface, in the white frames of all `lights` together, ambient light included. Where no pixel is
/// lit, over those that see a surface in ambient light; where that is black too, 1 cd/m².
double automatic_saturation_cd_per_m2(const SurfaceMap& surface, std::span<const LightMap> lights,
                                      double ambient_lx);

}  // namespace laterna
