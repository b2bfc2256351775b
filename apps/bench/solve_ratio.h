// What solving for a projector costs beside one pass over its correspondences.
#pragma once

namespace laterna {

/// Medians over repeats, on as many threads as are set: one million points of a known surface, a pinhole, 0.3
/// px of noise, 2,500 blocks.
struct SolveTimes {
  int passes = 0;        ///< over all points with residuals and Jacobians: of the solver, and the jackknife's
  double over_pass = 0;  ///< the whole solve over one such pass (row_factor)
  double seconds = 0;    ///< of the whole solve, from correspondences to verdict
};

/// Throws std::runtime_error where the solve does not end ok.
SolveTimes time_solve(int repeats);

}  // namespace laterna
