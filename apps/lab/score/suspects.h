// Who is to blame for a wrong calibration: named mistakes, most likely first.
#pragma once

#include "apps/lab/score/probe.h"
#include "calib/correspondences.h"

#include <string>
#include <vector>

namespace laterna {

/// One mistake. Names: size_swapped, half_pixel, y_flipped, inverse_pose, rotation_transposed, unit_scale,
/// axes_exchanged, gamma, keystone, overscan, dropped_frame, unconverged.
struct Suspect {
  std::string name;
  /// The share of the squared error that undoing it takes away: 1 - E(undone)/E, with E = squared_error_px2
  /// over the probe. Of pictures (picture_suspects.h) the share of their squared disagreement with the
  /// truth's patterns.
  double explains = 0;
  std::string words{};  ///< what was found, and what to change
};

/// What a result's geometry tells. `noise_px`: the rms that noise alone predicts over the volume, 0 where
/// that is not known. `decoded`: what pictures of the scene say, if anything, for unconverged.h. A suspect is
/// named where the error is more than five times the noise (and 1e-3 px), and undoing it leaves no more than
/// three times the noise, or explains
///
///   0.95  nothing fitted, the mistake far larger than a pixel
///   0.97  half_pixel, which chance comes near to
///   0.99  overscan and unconverged, which are fitted
///   0.999 keystone, whose numbers fit much
///
/// Sorted by what is left plus 0.1 % of the error for each fitted parameter (unconverged counts all). A
/// suspect with fitted parameters is left out where one before it, with fewer, explains as much to within 1 %
/// or leaves no more than three times the noise.
///
/// Where none leaves so little, two at once are tried (pairs.h): both are named in front, with what they
/// explain together, where they leave a tenth of what the best one leaves and explain 0.999.
///
/// unconverged needs a sign that a solver was stopped (unconverged.h); without one it is named only where
/// nobody else is, and the error is above thirty times the noise (ten where it does not look like noise): it
/// then says no more than that a solver that starts from this result ends at the truth.
std::vector<Suspect> geometric_suspects(const ScoreRig& result, const Probe& probe, double noise_px,
                                        const Correspondences& decoded = {});

/// What to change, a clause for people.
std::string advice(const std::string& suspect);

}  // namespace laterna
