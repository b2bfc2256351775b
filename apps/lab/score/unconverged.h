// Whether a result looks like a solve that was stopped before its end.
#pragma once

#include "apps/lab/score/probe.h"

#include <optional>

namespace laterna {

/// What a solver does with a result as its start.
struct Resolved {
  double remaining_px2 = 0;  ///< mean squared error at the end, on the probe's points
  bool is_stopped_descent = false;
  bool is_nominal_start = false;
};

/// Takes the result's projector as the start of a free least-squares solve on the true pixels of the probe.
/// Any wrong result that lies in the truth's basin ends at the truth, a random one too; what tells a stopped
/// solve apart is one of two signs, and only with one of them may it be named:
///
///   stopped descent  nine tenths of the error lie in the weaker half of the directions that the points tell
///                    (error_directions.h): descents reduce the stronger ones first. Noise puts a half there
///                    (nine tenths once in some forty), parameters wrong by chance hardly anything.
///   nominal start    fx = fy, and the centre exactly in the middle of the picture ((W-1)/2 or W/2), as a
///   solve
///                    begins, where the true ones differ by more than a pixel.
///
/// A Newton method that was stopped near its end in a well-conditioned problem shows neither, and cannot be
/// told from another small error. None where the result cannot be a start (a point behind it, a reflection,
/// another lens model than the truth's), or the solve does not end.
std::optional<Resolved> resolve_from(const ScoreRig& result, const Probe& probe);

}  // namespace laterna
