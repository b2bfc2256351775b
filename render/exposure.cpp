#include "render/exposure.h"

#include "sim/error.h"
#include "sim/instruction_sets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace laterna {

namespace {

constexpr int block = noise_pixels;

/// What the pixels of a block keep from picture to picture.
struct PixelGains {
  float response[block];  // 1 + PRNU, not negative
  float offset_dn[block];
};

/// The random numbers of a block for four pictures, drawn when they are asked for.
struct Draws {
  const NoiseKey& key;
  std::uint32_t first_pixel, group;
  bool has_words = false, has_shot = false;
  float temporal[noise_values], shot[noise_values];
  std::uint32_t words[noise_values];

  Draws(const NoiseKey& noise, std::uint32_t pixel, int four_pictures)
      : key(noise), first_pixel(pixel), group(std::uint32_t(four_pictures)) {
    normal_deviates(key, NoiseStream::temporal, first_pixel, group, temporal);
  }
  const std::uint32_t* count_words(int picture) {
    if (!has_words) random_words(key, NoiseStream::shot, first_pixel, group, words);
    has_words = true;
    return words + block * picture;
  }
  const float* shot_deviates(int picture) {
    if (!has_shot) normal_deviates(key, NoiseStream::shot, first_pixel, group, shot);
    has_shot = true;
    return shot + block * picture;
  }
};

PixelGains pixel_gains(const ElectronModel& model, std::uint32_t first_pixel) {
  float deviates[noise_values];
  normal_deviates(model.nonuniformity, NoiseStream::non_uniformity, first_pixel, 0, deviates);
  PixelGains gains{};
  for (int i = 0; i < block; ++i) {
    gains.response[i] = std::max(1 + model.prnu * deviates[i], 0.f);
    gains.offset_dn[i] = model.black_offset_dn + model.gain_dn_per_e * model.dsnu_e * deviates[block + i];
  }
  return gains;
}

/// Which kinds of pixels a block has beside those of medium light.
struct Kinds {
  bool dim, bright;
};

/// Whether shot noise may reach the full well.
inline bool near_full_well(float mean, float deviation, float full_well_e) {
  return mean + 8 * deviation > full_well_e;
}

/// Means, and DN before rounding where shot and dark noise are one normal deviate.
LATERNA_CLONES Kinds expose_medium(const ElectronModel& model, const PixelGains& gains, const float* levels,
                                   const float* deviates, float* means, float* signal) {
  const float dark_variance = model.dark_noise_e * model.dark_noise_e;
  const float dark_e = model.dark_e, gain = model.gain_dn_per_e, full_well_e = model.full_well_e;
  int dim = 0, bright = 0;
  for (int i = 0; i < block; ++i) {
    const float level = levels[i] > 0 ? levels[i] : 0;
    const float mean = gains.response[i] * level + dark_e, deviation = std::sqrt(mean + dark_variance);
    means[i] = mean;
    signal[i] = gain * (mean + deviation * deviates[i]) + gains.offset_dn[i];
    dim |= int(mean < greatest_poisson_mean);
    bright |= int(near_full_well(mean, deviation, full_well_e));
  }
  return {dim != 0, bright != 0};
}

/// Replaces those whose charge is a Poisson-distributed count.
LATERNA_CLONES void expose_dim(const ElectronModel& model, const PixelGains& gains, const float* means,
                               const float* counts, const float* deviates, float* signal) {
  const float full_well_e = model.full_well_e, dark_noise_e = model.dark_noise_e, gain = model.gain_dn_per_e;
  for (int i = 0; i < block; ++i) {
    const float charge = counts[i] < full_well_e ? counts[i] : full_well_e;
    const float electrons = charge + dark_noise_e * deviates[i];
    const float dim = gain * electrons + gains.offset_dn[i];
    signal[i] = means[i] < greatest_poisson_mean ? dim : signal[i];
  }
}

/// Replaces those whose charge may reach the full well.
LATERNA_CLONES void expose_bright(const ElectronModel& model, const PixelGains& gains, const float* means,
                                  const float* shot, const float* deviates, float* signal) {
  const float full_well_e = model.full_well_e, dark_noise_e = model.dark_noise_e, gain = model.gain_dn_per_e;
  const float dark_variance = dark_noise_e * dark_noise_e;
  for (int i = 0; i < block; ++i) {
    const float drawn = means[i] + std::sqrt(means[i]) * shot[i];
    const float positive = drawn > 0 ? drawn : 0;
    const float charge = positive < full_well_e ? positive : full_well_e;
    const float electrons = charge + dark_noise_e * deviates[i];
    const float bright = gain * electrons + gains.offset_dn[i];
    const float deviation = std::sqrt(means[i] + dark_variance);
    const int near =
        int(near_full_well(means[i], deviation, full_well_e)) & int(means[i] >= greatest_poisson_mean);
    signal[i] = near != 0 ? bright : signal[i];
  }
}

void expose_electrons(const Exposure& exposure, const PixelGains& gains, Draws& draws, int picture,
                      const float* levels, float* signal) {
  const ElectronModel& model = *exposure.electrons;
  float means[block], counts[block];
  const float* deviates = draws.temporal + block * picture;
  const Kinds kinds = expose_medium(model, gains, levels, deviates, means, signal);
  if (kinds.dim) {
    poisson_counts(means, draws.count_words(picture), counts);
    expose_dim(model, gains, means, counts, deviates, signal);
  }
  if (kinds.bright) expose_bright(model, gains, means, draws.shot_deviates(picture), deviates, signal);
  if (model.response_exponent == 1) return;
  const auto full_scale = static_cast<float>(exposure.full_scale());
  for (int i = 0; i < block; ++i) {
    const float share = std::clamp(signal[i] / full_scale, 0.f, 1.f);
    signal[i] = full_scale * std::pow(share, model.response_exponent);
  }
}

LATERNA_CLONES void add_noise(float sigma, const float* levels, const float* deviates, float* signal) {
  for (int i = 0; i < block; ++i) signal[i] = levels[i] + sigma * deviates[i];
}

LATERNA_CLONES void quantise(const float* signal, float full_scale, std::uint8_t* dn) {
  for (int i = 0; i < block; ++i) {
    const float above = signal[i] > 0 ? signal[i] : 0;
    dn[i] = std::uint8_t(int((above < full_scale ? above : full_scale) + 0.5f));
  }
}

LATERNA_CLONES void quantise(const float* signal, float full_scale, std::uint16_t* dn) {
  for (int i = 0; i < block; ++i) {
    const float above = signal[i] > 0 ? signal[i] : 0;
    dn[i] = std::uint16_t(int((above < full_scale ? above : full_scale) + 0.5f));
  }
}

template <class Number>
void expose_block(const Exposure& exposure, std::uint32_t first_pixel, int pictures, const float* levels,
                  Number* dn) {
  const auto full_scale = static_cast<float>(exposure.full_scale());
  const auto sigma = static_cast<float>(exposure.noise_sigma_dn);
  if (!exposure.electrons && !(sigma > 0)) {
    for (int k = 0; k < pictures; ++k) quantise(levels + k * block, full_scale, dn + k * block);
    return;
  }
  const PixelGains gains = exposure.electrons ? pixel_gains(*exposure.electrons, first_pixel) : PixelGains{};
  float signal[block];
  for (int first = 0; first < pictures; first += noise_pictures) {
    Draws draws(exposure.noise, first_pixel, first / noise_pictures);
    for (int k = first; k < std::min(first + noise_pictures, pictures); ++k) {
      const float* level = levels + k * block;
      if (exposure.electrons)
        expose_electrons(exposure, gains, draws, k - first, level, signal);
      else
        add_noise(sigma, level, draws.temporal + (k - first) * block, signal);
      quantise(signal, full_scale, dn + k * block);
    }
  }
}

ElectronModel electron_model(const Sensor& sensor, double saturation_cd_per_m2, const NoiseKey& noise) {
  const double time_s =
      sensor.exposure_time_s ? *sensor.exposure_time_s : exposure_time_s(sensor, saturation_cd_per_m2);
  if (!(time_s > 0 && std::isfinite(time_s)))
    throw InputError(fmt::format("sensor: {} cd/m² would need an exposure of {} s, expected more light",
                                 saturation_cd_per_m2, time_s));
  ElectronModel model;
  model.exposure_time_s = time_s;
  model.electrons_per_cd_per_m2 = electrons_per_s_and_cd_per_m2(sensor) * time_s;
  model.dark_e = static_cast<float>(sensor.dark_current_e_per_s * time_s);
  model.full_well_e = static_cast<float>(sensor.full_well_e);
  model.dark_noise_e = static_cast<float>(sensor.dark_noise_e);
  model.dsnu_e = static_cast<float>(sensor.dsnu_e);
  model.prnu = static_cast<float>(sensor.prnu);
  model.gain_dn_per_e = static_cast<float>(system_gain_dn_per_e(sensor));
  model.black_offset_dn = static_cast<float>(sensor.black_offset_dn);
  model.response_exponent = static_cast<float>(sensor.response_exponent);
  model.nonuniformity = {sensor.nonuniformity_seed, noise.camera, 0};
  return model;
}

}  // namespace

Exposure make_exposure(const Sensor& sensor, double saturation_cd_per_m2, const NoiseKey& noise) {
  check(sensor);
  const double saturation = fixed_saturation_cd_per_m2(sensor).value_or(saturation_cd_per_m2);
  if (!(saturation > 0 && std::isfinite(saturation)))
    throw InputError(
        fmt::format("sensor: saturation_cd_per_m2 is {}, expected a positive number", saturation));
  Exposure exposure{sensor.bit_depth, saturation, sensor.noise_sigma_dn, noise, {}};
  if (sensor.kind == SensorKind::emva1288) exposure.electrons = electron_model(sensor, saturation, noise);
  return exposure;
}

void expose(const Exposure& exposure, std::uint32_t first_pixel, int pictures, const float* levels,
            std::uint8_t* dn) {
  expose_block(exposure, first_pixel, pictures, levels, dn);
}

void expose(const Exposure& exposure, std::uint32_t first_pixel, int pictures, const float* levels,
            std::uint16_t* dn) {
  expose_block(exposure, first_pixel, pictures, levels, dn);
}

}  // namespace laterna
