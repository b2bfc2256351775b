// The least lens model that the data support: terms climb in one at a time, each judged by what it forecasts.
#pragma once

#include "calib/boards/held_out.h"

#include <string>
#include <vector>

namespace laterna {

/// One model that was tried.
struct Rung {
  std::vector<std::vector<std::string>> terms;  ///< of each device (rig.h: lens_terms())
  bool bend = false;                            ///< the board's bend is free
  std::string added;                            ///< "camera k1"; empty for the first
  bool solved = false;                          ///< it, and every fold of it
  bool chosen = false;                          ///< the climb went through it
  std::vector<double> fit_rms_px;               ///< of each device
  HeldOut held_out;
  double typical_px = 0;  ///< geometric mean of the folds' rms: what the climb compares
  double scatter_px = 0;  ///< standard deviation of the folds' rms
  /// Paired over the folds against the rung that it was tried on: mean of ln(rms before / rms after) over its
  /// standard error. Positive: it forecasts better. 0 for the first.
  double gain_over_error = 0;
  std::string moved;  ///< what changed most: "projector cy +103.2"
};

struct Ladder {
  std::vector<Rung> rungs;  ///< in the order in which they were tried
  RigFit fit;               ///< of the model that won
  std::size_t winner = 0;   ///< index among the rungs
};

struct LadderOptions {
  double least_gain_over_error = 1;  ///< a term's paired gain must be above this many standard errors
  double least_gain = 0.01;          ///< and the folds' geometric mean must fall by this share
  /// The board's bend: held at 0, a term that may climb in, or free on every rung.
  enum class Bend { off, climbs, on } bend = Bend::climbs;
  bool one_focal_length = false, fixed_center = false;
};

/// Over the poses that both have: the mean of ln(rms before / rms after) over its standard error. 0 for fewer
/// than two.
double paired_gain_over_error(const HeldOut& before, const HeldOut& after);

/// The distortion terms that may come next, given those that stand: k1; then k2 and p1p2; k3 after k2; k456
/// after k3.
std::vector<std::string> next_lens_terms(const std::vector<std::string>& terms);

/// With one more, in the order in which OpenCV's models have them.
std::vector<std::string> with_lens_term(const std::vector<std::string>& terms, const std::string& term);

/// Of the folds' rms: one that extrapolates far does not drown the others. 0 without folds.
double geometric_mean_px(const HeldOut& held_out);

/// The rule of the climb: the paired gain over the folds is above `least_gain_over_error` standard errors,
/// and the geometric mean of the folds' rms falls by `least_gain`.
bool forecasts_better(const HeldOut& before, const HeldOut& after, const LadderOptions& options = {});

/// Climbs from pinhole with free centre. Each step tries every term that may come next on each device, the
/// board's bend and, first of all, k1 on all devices at once. Every candidate is fitted (fit_rig) and leaves
/// each pose out in turn. It passes where every fold solves and it forecasts better. Of those that pass, the
/// one with the smallest geometric mean is the next rung; with none the climb ends. (A mean of logarithms,
/// since one fold that extrapolates far would drown the others in a mean of squares.) The held-out rms of the
/// winner is the least of several and so a little too good.
///
/// Fewer than three poses leave nothing to test: the first rung is the last. Throws Refusal where pinhole
/// itself cannot be fitted.
Ladder climb(const BoardCapture& capture, const BoardRig& start, bool estimate_sigma,
             const LadderOptions& options = {});

/// The one rung of a given model, as on the ladder; the bend is free only with Bend::on. Throws Refusal where
/// it cannot be fitted.
Ladder single_rung(const BoardCapture& capture, const BoardRig& start, bool estimate_sigma,
                   const std::vector<std::vector<std::string>>& terms, const LadderOptions& options = {});

}  // namespace laterna
