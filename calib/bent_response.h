// A response that is not linear, told by sums of steps, and what it does to phases.
#pragma once

namespace laterna {

/// The rms shift, in projector pixels, of places by N-step phase where light = value^γ, γ > 0: the N ± 1st
/// harmonics are taken for the first.
double response_shift_px(double gamma, int steps, double pitch_px);

/// The sum of a fringe's steps tells how bent the response is: for light = value^γ the mean of the steps is
/// off half of white and black by g(γ) = mean(((1 + cos θ)/2)^γ) - 1/2. `mean_rest` is |g|, of whatever sign.
/// Returned is the rms shift under the γ ≥ 1 that gives this |g|. 0 for no rest; γ up to 8.
///
/// At 64 px: γ = 2.2 shifts by 2.1 px with N = 3, by 0.08 with 4, by less than 0.002 with 8.
double bent_response_shift_px(double mean_rest, int steps, double pitch_px);

}  // namespace laterna
