#include "render/exposure.h"

#include "render/exposure_kernels.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace laterna {

namespace {

constexpr int block = noise_pixels;

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

void expose_electrons(const Exposure& exposure, const PixelGains& gains, Draws& draws, int picture,
                      const float* levels, float* signal) {
  const ElectronModel& model = *exposure.electrons;
  float means[block], counts[block];
  const float* deviates = draws.temporal + block * picture;
  const LightKinds kinds = expose_medium(model, gains, levels, deviates, means, signal);
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

template <class Number>
void expose_block(const Exposure& exposure, std::uint32_t first_pixel, int pictures, const float* levels,
                  Number* dn) {
  const auto full_scale = static_cast<float>(exposure.full_scale());
  const auto sigma = static_cast<float>(exposure.noise_sigma_dn);
  if (!exposure.electrons && !(sigma > 0)) {
    quantise(levels, full_scale, pictures * block, dn);
    return;
  }
  const PixelGains gains = exposure.electrons ? pixel_gains(*exposure.electrons, first_pixel) : PixelGains{};
  float signal[block];
  for (int first = 0; first < pictures; first += noise_pictures) {
    const int end = std::min(first + noise_pictures, pictures);
    Draws draws(exposure.noise, first_pixel, first / noise_pictures);
    if (!exposure.electrons) {
      quantise_noisy(levels + first * block, sigma, draws.temporal, full_scale, (end - first) * block,
                     dn + first * block);
      continue;
    }
    for (int k = first; k < end; ++k) {
      expose_electrons(exposure, gains, draws, k - first, levels + k * block, signal);
      quantise(signal, full_scale, block, dn + k * block);
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
