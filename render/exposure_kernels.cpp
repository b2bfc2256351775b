#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/exposure_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/exposure_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace laterna::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, noise_pixels>;
using FloatV = hn::Vec<Floats>;
constexpr Floats f;
constexpr std::size_t block = noise_pixels;

HWY_INLINE FloatV set(float x) { return hn::Set(f, x); }
HWY_INLINE FloatV positive(FloatV x) { return hn::IfThenElseZero(hn::Gt(x, set(0)), x); }

// Whether shot noise may reach the full well.
HWY_INLINE auto near_full_well(FloatV mean, FloatV deviation, float full_well_e) {
  return hn::Gt(hn::Add(mean, hn::Mul(set(8), deviation)), set(full_well_e));
}

// DN of a charge that is read with dark noise.
HWY_INLINE FloatV read(const ElectronModel& model, FloatV charge, FloatV deviate, FloatV offset_dn) {
  const FloatV electrons = hn::Add(charge, hn::Mul(set(model.dark_noise_e), deviate));
  return hn::Add(hn::Mul(set(model.gain_dn_per_e), electrons), offset_dn);
}

LightKinds expose_medium(const ElectronModel& model, const PixelGains& gains, const float* levels,
                         const float* deviates, float* means, float* signal) {
  const FloatV dark_variance = set(model.dark_noise_e * model.dark_noise_e);
  LightKinds kinds;
  for (std::size_t i = 0; i < block; i += hn::Lanes(f)) {
    const FloatV level = positive(hn::LoadU(f, levels + i));
    const FloatV mean = hn::Add(hn::Mul(hn::LoadU(f, gains.response + i), level), set(model.dark_e));
    const FloatV deviation = hn::Sqrt(hn::Add(mean, dark_variance));
    const FloatV electrons = hn::Add(mean, hn::Mul(deviation, hn::LoadU(f, deviates + i)));
    hn::StoreU(mean, f, means + i);
    hn::StoreU(hn::Add(hn::Mul(set(model.gain_dn_per_e), electrons), hn::LoadU(f, gains.offset_dn + i)), f,
               signal + i);
    kinds.dim |= !hn::AllFalse(f, hn::Lt(mean, set(greatest_poisson_mean)));
    kinds.bright |= !hn::AllFalse(f, near_full_well(mean, deviation, model.full_well_e));
  }
  return kinds;
}

void expose_dim(const ElectronModel& model, const PixelGains& gains, const float* means, const float* counts,
                const float* deviates, float* signal) {
  for (std::size_t i = 0; i < block; i += hn::Lanes(f)) {
    const FloatV charge = hn::Min(hn::LoadU(f, counts + i), set(model.full_well_e));
    const FloatV dim = read(model, charge, hn::LoadU(f, deviates + i), hn::LoadU(f, gains.offset_dn + i));
    const auto is_dim = hn::Lt(hn::LoadU(f, means + i), set(greatest_poisson_mean));
    hn::StoreU(hn::IfThenElse(is_dim, dim, hn::LoadU(f, signal + i)), f, signal + i);
  }
}

void expose_bright(const ElectronModel& model, const PixelGains& gains, const float* means, const float* shot,
                   const float* deviates, float* signal) {
  const FloatV dark_variance = set(model.dark_noise_e * model.dark_noise_e);
  for (std::size_t i = 0; i < block; i += hn::Lanes(f)) {
    const FloatV mean = hn::LoadU(f, means + i);
    const FloatV drawn = hn::Add(mean, hn::Mul(hn::Sqrt(mean), hn::LoadU(f, shot + i)));
    const FloatV charge = hn::Min(positive(drawn), set(model.full_well_e));
    const FloatV bright = read(model, charge, hn::LoadU(f, deviates + i), hn::LoadU(f, gains.offset_dn + i));
    const FloatV deviation = hn::Sqrt(hn::Add(mean, dark_variance));
    const auto near =
        hn::And(near_full_well(mean, deviation, model.full_well_e), hn::Ge(mean, set(greatest_poisson_mean)));
    hn::StoreU(hn::IfThenElse(near, bright, hn::LoadU(f, signal + i)), f, signal + i);
  }
}

template <class Number>
HWY_INLINE void write_dn(FloatV signal, float full_scale, Number* dn) {
  const hn::Rebind<std::int32_t, Floats> ints;
  const hn::Rebind<Number, Floats> numbers;
  const FloatV clamped = hn::Min(positive(signal), set(full_scale));
  hn::StoreU(hn::DemoteTo(numbers, hn::ConvertTo(ints, hn::Add(clamped, set(0.5f)))), numbers, dn);
}

template <class Number>
HWY_INLINE void quantise(const float* signal, float full_scale, int count, Number* dn) {
  for (std::size_t i = 0; i < std::size_t(count); i += hn::Lanes(f))
    write_dn(hn::LoadU(f, signal + i), full_scale, dn + i);
}

template <class Number>
HWY_INLINE void quantise_noisy(const float* signal, float sigma, const float* deviates, float full_scale,
                               int count, Number* dn) {
  for (std::size_t i = 0; i < std::size_t(count); i += hn::Lanes(f)) {
    const FloatV noise = hn::Mul(set(sigma), hn::LoadU(f, deviates + i));
    write_dn(hn::Add(hn::LoadU(f, signal + i), noise), full_scale, dn + i);
  }
}

void quantise_8(const float* signal, float full_scale, int count, std::uint8_t* dn) {
  quantise(signal, full_scale, count, dn);
}
void quantise_16(const float* signal, float full_scale, int count, std::uint16_t* dn) {
  quantise(signal, full_scale, count, dn);
}
void quantise_noisy_8(const float* signal, float sigma, const float* deviates, float full_scale, int count,
                      std::uint8_t* dn) {
  quantise_noisy(signal, sigma, deviates, full_scale, count, dn);
}
void quantise_noisy_16(const float* signal, float sigma, const float* deviates, float full_scale, int count,
                       std::uint16_t* dn) {
  quantise_noisy(signal, sigma, deviates, full_scale, count, dn);
}

}  // namespace
}  // namespace laterna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace laterna {

namespace {
HWY_EXPORT(expose_medium);
HWY_EXPORT(expose_dim);
HWY_EXPORT(expose_bright);
HWY_EXPORT(quantise_8);
HWY_EXPORT(quantise_16);
HWY_EXPORT(quantise_noisy_8);
HWY_EXPORT(quantise_noisy_16);
}  // namespace

LightKinds expose_medium(const ElectronModel& model, const PixelGains& gains, const float* levels,
                         const float* deviates, float* means, float* signal) {
  return HWY_DYNAMIC_DISPATCH(expose_medium)(model, gains, levels, deviates, means, signal);
}

void expose_dim(const ElectronModel& model, const PixelGains& gains, const float* means, const float* counts,
                const float* deviates, float* signal) {
  HWY_DYNAMIC_DISPATCH(expose_dim)(model, gains, means, counts, deviates, signal);
}

void expose_bright(const ElectronModel& model, const PixelGains& gains, const float* means, const float* shot,
                   const float* deviates, float* signal) {
  HWY_DYNAMIC_DISPATCH(expose_bright)(model, gains, means, shot, deviates, signal);
}

void quantise(const float* signal, float full_scale, int count, std::uint8_t* dn) {
  HWY_DYNAMIC_DISPATCH(quantise_8)(signal, full_scale, count, dn);
}

void quantise(const float* signal, float full_scale, int count, std::uint16_t* dn) {
  HWY_DYNAMIC_DISPATCH(quantise_16)(signal, full_scale, count, dn);
}

void quantise_noisy(const float* signal, float sigma, const float* deviates, float full_scale, int count,
                    std::uint8_t* dn) {
  HWY_DYNAMIC_DISPATCH(quantise_noisy_8)(signal, sigma, deviates, full_scale, count, dn);
}

void quantise_noisy(const float* signal, float sigma, const float* deviates, float full_scale, int count,
                    std::uint16_t* dn) {
  HWY_DYNAMIC_DISPATCH(quantise_noisy_16)(signal, sigma, deviates, full_scale, count, dn);
}

}  // namespace laterna
#endif
