// The hot loops of phase shifting. Compiled for several instruction sets, with the same bits from all.
#pragma once

#include <cstddef>
#include <cstdint>

namespace laterna {

/// A sinusoid seen at each of `count` pixels: I_j = mean + c·cos δ_j - s·sin δ_j with c = B·cos φ, s = B·sin
/// φ.
struct FringeArrays {
  float *mean, *c, *s;
  float* turns;  ///< φ/2π in [0, 1), within 5e-6 rad of atan2
};

/// Least squares for equal steps δ_j = 2π·j/steps; `cosines` and `sines` hold 2/steps·cos δ_j and
/// -2/steps·sin δ_j. Where B is 0, turns is 0.
void fit_fringe(const std::uint8_t* const* pictures, int steps, const float* cosines, const float* sines,
                std::size_t count, const FringeArrays& out);
void fit_fringe(const std::uint16_t* const* pictures, int steps, const float* cosines, const float* sines,
                std::size_t count, const FringeArrays& out);

/// What tells how good a fitted fringe is, where every sample has the variance `constant` (DN²) and none
/// saturates. `cosines` and `sines` hold cos δ_j and sin δ_j.
template <class T>
struct FringeSamples {
  const T* const* pictures;
  int steps;
  const float *cosines, *sines;
  const T *white, *black;  ///< their sum tells the mean where white is below full_scale
  float full_scale, constant;
  float min_modulation;          ///< B at least this
  float max_variance, max_chi2;  ///< of φ in rad², without the misfit; per degree of freedom
};

/// variance = 2·constant/(steps·B²)/(2π)² of φ/2π, times χ² per degree of freedom where that is above
/// max_chi2 (fringe_fit.h); infinite where the modulation is too small.
void fringe_variance(const FringeSamples<std::uint8_t>& samples, const float* mean, const float* c,
                     const float* s, std::size_t count, float* variance);
void fringe_variance(const FringeSamples<std::uint16_t>& samples, const float* mean, const float* c,
                     const float* s, std::size_t count, float* variance);

/// atan2(s, c)/2π in [0, 1); 0 for (0, 0).
void turns_of(const float* c, const float* s, std::size_t count, float* turns);

/// The best two of the whole periods that a wrapped phase may belong to.
struct PeriodArrays {
  float *best, *cost,
      *second_cost;  ///< `best` holds the whole number; costs are infinite where there is none
};

/// The places to choose from: x_k = (k + turns)·pitch_px for whole k from first to last, within [low, high].
struct PeriodSearch {
  const float* turns;
  float pitch_px;
  int first, last;
  float low_px, high_px;
};

/// A second fringe as witness: cost_k += weight·(pitch·wrap(x_k/pitch - turns))², wrap(v) = v - round(v).
struct PhaseWitness {
  const float *turns, *weight;
  float pitch_px;
};
void choose_period(const PeriodSearch& search, const PhaseWitness* witnesses, int count_witnesses,
                   std::size_t count, const PeriodArrays& out);

/// A single picture as witness: cost_k += (rest - c·cos 2πkr + s·sin 2πkr)², r = pitch/pitch of the witness,
/// where c = B·cos(2π·turns·r) and s = B·sin(2π·turns·r).
struct SampleWitness {
  const float *rest, *c, *s;
  const float *cosines, *sines;  ///< cos 2πkr and sin 2πkr for k = first, first + 1, ...
};
void choose_period(const PeriodSearch& search, const SampleWitness* witnesses, int count_witnesses,
                   std::size_t count, const PeriodArrays& out);

}  // namespace laterna
