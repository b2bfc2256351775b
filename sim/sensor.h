// What a camera measures with: an ideal sensor, or the linear camera model of EMVA 1288 (release 4), with its
// words: electrons = quantum efficiency · photons, digital numbers = system gain · electrons.
#pragma once

#include <cstdint>
#include <optional>

namespace laterna {

enum class SensorKind { ideal, emva1288 };

/// Ideal: DN = round(full_scale·L/saturation + noise), clamped to [0, full_scale], full_scale = 2^bit_depth -
/// 1.
///
/// EMVA 1288, for the luminance L cd/m² of what a pixel sees, on the axis of a lens focused far away:
///   irradiance  E = π/4·L·lens_transmission/f_number²                      lx
///   photons     μ_p = E/luminous_efficacy · pixel_pitch²·exposure_time·wavelength/(h·c)
///   electrons   N = Poisson((1 + PRNU)·quantum_efficiency·μ_p + dark_current·exposure_time), at most
///   full_well signal      y = system_gain·(N + DSNU + Normal(0, dark_noise²)) + black_offset DN picture DN =
///   round(full_scale·(y/full_scale)^response_exponent), y clamped to [0, full_scale]
/// PRNU and DSNU are fixed normal deviates of each pixel.
struct Sensor {
  int bit_depth = 8;                             ///< 8, or 9 to 16 in 16-bit files
  double noise_sigma_dn = 0;                     ///< ideal only: Gaussian, before rounding
  std::optional<double> saturation_cd_per_m2{};  ///< the luminance L that fills the scale
  SensorKind kind = SensorKind::ideal;

  // EMVA 1288 only. The defaults are those of a common global-shutter machine-vision camera.
  std::optional<double> exposure_time_s{};
  double f_number = 4, lens_transmission = 0.9;
  double pixel_pitch_m = 3.45e-6;
  double quantum_efficiency = 0.6;  ///< electrons per photon; the share of the pixel's area included
  double wavelength_m = 555e-9;
  double luminous_efficacy_lm_per_w = 683;  ///< of the light; 683 lm/W at 555 nm
  double full_well_e = 10500;
  std::optional<double> system_gain_dn_per_e{};  ///< K; absent: the full well fills the scale
  double dark_noise_e = 2.4;                     ///< σ_d0: read-out noise, without that of the dark current
  double dark_current_e_per_s = 3;
  double black_offset_dn = 4;
  double dsnu_e = 1, prnu = 0.004;  ///< standard deviations over the pixels
  std::uint64_t nonuniformity_seed = 1;
  double response_exponent = 1;
  bool operator==(const Sensor&) const = default;
};

/// Throws InputError, beginning with "sensor: ", where a parameter is out of its range (sim/scene_fields.h),
/// belongs to the other kind and is not at its default, where saturation and exposure time are both given, or
/// where the black offset leaves no scale.
void check(const Sensor& sensor);

/// 2^bit_depth - 1.
inline int full_scale_dn(const Sensor& sensor) { return (1 << sensor.bit_depth) - 1; }

/// K of an EMVA sensor: its own, or (full_scale - black_offset)/full_well.
double system_gain_dn_per_e(const Sensor& sensor);

/// The mean charge that fills the scale of an EMVA sensor: (full_scale - black_offset)/K, or the full well
/// where that is less.
double capacity_e(const Sensor& sensor);

/// Mean photo-electrons per second and cd/m² of an EMVA sensor: quantum_efficiency·μ_p for L = 1 cd/m² and 1
/// s.
double electrons_per_s_and_cd_per_m2(const Sensor& sensor);

/// The exposure time with which photo-electrons of the given luminance and dark current together reach
/// capacity_e().
double exposure_time_s(const Sensor& sensor, double saturation_cd_per_m2);

/// The luminance that fills the scale, where the sensor's parameters fix it: saturation_cd_per_m2, or for an
/// EMVA sensor with an exposure time the inverse of exposure_time_s(). Empty: automatic exposure. Throws
/// InputError where the dark current alone fills the scale within the exposure time.
std::optional<double> fixed_saturation_cd_per_m2(const Sensor& sensor);

}  // namespace laterna
