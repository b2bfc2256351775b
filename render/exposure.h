// From light to digital numbers: the sensor at work, and the exposure that suits a scene.
#pragma once

#include "render/direct_light.h"
#include "render/noise.h"
#include "render/surface.h"
#include "sim/scene.h"

#include <cstdint>
#include <numbers>
#include <optional>
#include <span>

namespace laterna {

/// L = albedo/π·(E + ambient), in cd/m²: a Lambertian surface under E lx from the projector and ambient_lx
/// from everywhere.
inline double luminance_cd_per_m2(double albedo, double illuminance_lx, double ambient_lx) {
  return albedo / std::numbers::pi * (illuminance_lx + ambient_lx);
}

/// The linear camera model of EMVA 1288 (sim/sensor.h) at one exposure time, in single precision.
struct ElectronModel {
  double exposure_time_s = 0;
  double electrons_per_cd_per_m2 = 0;  ///< mean photo-electrons within the exposure time, PRNU aside
  float dark_e = 0;                    ///< mean electrons of the dark current
  float full_well_e = 0, dark_noise_e = 0, dsnu_e = 0, prnu = 0;
  float gain_dn_per_e = 0, black_offset_dn = 0;
  float response_exponent = 1;
  NoiseKey nonuniformity;
};

/// Ideal: DN = round(full_scale·L/saturation + noise), halves up, clamped to [0, full_scale]. With
/// `electrons`: the EMVA model instead, whose noise_sigma_dn is 0; saturation is where the mean fills the
/// scale.
struct Exposure {
  int bit_depth = 8;  ///< 8 to 16
  double saturation_cd_per_m2 = 1;
  double noise_sigma_dn = 0;
  NoiseKey noise;
  std::optional<ElectronModel> electrons{};

  int full_scale() const { return (1 << bit_depth) - 1; }

  /// A pixel's *level*, as expose() takes it, for 1 cd/m²: linear DN, or mean photo-electrons.
  double level_per_cd_per_m2() const {
    return electrons ? electrons->electrons_per_cd_per_m2 : full_scale() / saturation_cd_per_m2;
  }
};

/// The sensor's exposure; `saturation_cd_per_m2` stands in where the sensor's parameters fix none (an EMVA
/// sensor then takes the exposure time that this asks for). Throws InputError where check() refuses the
/// sensor, or where the saturation is not positive or not finite, or so dim that no exposure time will do.
Exposure make_exposure(const Sensor& sensor, double saturation_cd_per_m2, const NoiseKey& noise);

/// Digital numbers of up to 64 pixels in every picture: levels[64·k + i] and dn[64·k + i] are of pixel
/// first_pixel + i, in the camera's order, in picture k of `pictures`. Levels are luminance times
/// level_per_cd_per_m2(), finite; what stands beyond the block's last pixel changes nothing else.
///
/// Electrons with a mean of 30 or more and 8 standard deviations below the full well have their shot and dark
/// noise from one normal deviate. Below 30 they are Poisson-distributed counts; near the full well they have
/// a normal deviate of their own, so that the dark noise is added to the full well. All is a function of the
/// noise key, pixel and picture alone.
void expose(const Exposure& exposure, std::uint32_t first_pixel, int pictures, const float* levels,
            std::uint8_t* dn);
void expose(const Exposure& exposure, std::uint32_t first_pixel, int pictures, const float* levels,
            std::uint16_t* dn);

}  // namespace laterna
