// Wrapped phases of one axis to places: which period of the first fringe, and where in it.
#pragma once

#include "calib/fringe_fit.h"
#include "calib/fringe_kernel.h"
#include "sim/image_view.h"
#include "sim/pattern_sequence.h"

#include <cstdint>
#include <vector>

namespace laterna {

/// When a place counts as told.
struct UnwrapLimits {
  double max_disagreement_sigmas = 6;  ///< of each witness, in the mean square
  double min_margin_sigmas = 4;  ///< the runner-up's -2·log likelihood lies at least this squared above
};

/// Projector columns or rows of `count` pixels.
struct Places {
  std::vector<double> place_px;
  std::vector<double> variance;  ///< px²
  std::vector<Reject> why;

  explicit Places(std::size_t count) : place_px(count, 0), variance(count, 0), why(count, Reject::none) {}
};

/// One axis of a stack, from pixel `begin` on.
template <class T>
struct AxisPictures {
  ImageStackView<T> stack;
  const PatternSequence& sequence;
  int axis;
  std::size_t begin, count;
};

/// gray_phase: the period whose place is nearest to the middle of the code's half-period stripe; `disagree`
/// where it is more than 3/8 of a period from it (a code right by one stripe is within 1/4), `pair` where a
/// pattern and its inverse differ by less than `min_pair_dn`.
template <class T>
Places unwrap_by_code(const AxisPictures<T>& pictures, const FringeFit& fringe, double min_pair_dn);

/// phase, multi_frequency: of all periods inside the projector the one where the fringes agree best, by
/// Σ_m (p_m·wrap(x/p_m - φ_m/2π))²/(σ_m² + σ_0²); then the mean of all fringes by their variances. This is
/// temporal and heterodyne unwrapping in one: periods that grow to the projector's size, and close ones with
/// a long beat. `fringes` are those of fringe_pitches_px(), finest first.
Places unwrap_by_phases(const std::vector<double>& pitches_px, int size_px,
                        const std::vector<FringeFit>& fringes, const UnwrapLimits& limits);

/// micro_phase: the period whose prediction I = A + B·cos(2πx/p) fits the single pictures best, then
/// Gauss-Newton for x, A and B on all samples. `disagree` too where their χ² per degree of freedom is above
/// 9: the period hangs on the samples' own size.
template <class T>
Places unwrap_by_samples(const AxisPictures<T>& pictures, const FringeFit& fringe, const SampleNoise& noise,
                         double full_scale_dn, const UnwrapLimits& limits);

/// What the last two share: the period of the first fringe that each pixel lies in, with what that costs.
struct Periods {
  std::vector<float> best, cost, second_cost;
  explicit Periods(std::size_t count) : best(count), cost(count), second_cost(count) {}
  PeriodArrays arrays() { return {best.data(), cost.data(), second_cost.data()}; }
};

/// All periods that reach into the projector.
PeriodSearch period_search(const FringeFit& first, double pitch_px, int size_px);

/// `outside` where no period was possible, `disagree` beyond the limits.
Reject judge_period(float cost, float second_cost, std::size_t witnesses, const UnwrapLimits& limits);

/// Whether a place lies on the projector's picture, [-0.5, size - 0.5].
inline bool is_inside(double place_px, int size_px) { return place_px >= -0.5 && place_px <= size_px - 0.5; }

}  // namespace laterna
