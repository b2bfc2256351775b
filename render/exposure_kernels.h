// The hot loops of exposure, over blocks of 64 pixels. Each is compiled for several instruction sets, with
// the same bits from all.
#pragma once

#include "render/exposure.h"

#include <cstdint>

namespace laterna {

/// What the pixels of a block keep from picture to picture.
struct PixelGains {
  float response[noise_pixels];  ///< 1 + PRNU, not negative
  float offset_dn[noise_pixels];
};

/// Which kinds of pixels a block has beside those of medium light.
struct LightKinds {
  bool dim = false, bright = false;
};

/// Mean electrons, and DN before rounding where shot and dark noise are one normal deviate.
LightKinds expose_medium(const ElectronModel& model, const PixelGains& gains, const float* levels,
                         const float* deviates, float* means, float* signal);

/// Replaces those whose charge is a Poisson-distributed count.
void expose_dim(const ElectronModel& model, const PixelGains& gains, const float* means, const float* counts,
                const float* deviates, float* signal);

/// Replaces those whose charge may reach the full well.
void expose_bright(const ElectronModel& model, const PixelGains& gains, const float* means, const float* shot,
                   const float* deviates, float* signal);

/// dn = signal clamped to [0, full_scale], rounded, halves up; NaN is 0. `count`, a multiple of 64.
void quantise(const float* signal, float full_scale, int count, std::uint8_t* dn);
void quantise(const float* signal, float full_scale, int count, std::uint16_t* dn);

/// The same of signal + sigma·deviates.
void quantise_noisy(const float* signal, float sigma, const float* deviates, float full_scale, int count,
                    std::uint8_t* dn);
void quantise_noisy(const float* signal, float sigma, const float* deviates, float full_scale, int count,
                    std::uint16_t* dn);

}  // namespace laterna
