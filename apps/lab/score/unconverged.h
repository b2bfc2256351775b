// Whether a result looks like a solve that was stopped before its end.
#pragma once

#include "apps/lab/score/probe.h"
#include "calib/correspondences.h"

#include <optional>

namespace laterna {

/// What a solver does with a result as its start.
struct Resolved {
  double remaining_px2 = 0;  ///< squared_error_px2 at the end, on the probe's points
  bool is_stopped_descent = false;
  bool is_nominal_start = false;
  bool is_like_noise = false;
};

/// Takes the result's projector as the start of a free least-squares solve of its own lens model. `decoded`
/// holds what the pictures say; the true pixels of the probe stand in where it is empty. What ends at the
/// truth on decoded points was not where a solver ends: the points are not to blame. Signs of where it was
/// stopped:
///
///   stopped descent  nine tenths of the error lie in the weaker half of the directions that the points tell
///                    (error_directions.h): descents reduce the stronger ones first
///   nominal start    fx = fy, and the centre exactly in the middle of the picture ((W-1)/2 or W/2), as a
///                    solve begins, where the true ones differ by more than a pixel; a pinhole then starts
///                    with the true lens model
///   like noise       neither half of the directions holds nine tenths. Noise that a solve has passed on puts
///                    about a half into each, and a larger share than that into one half once in some forty.
///
/// Newton's method stopped after a step or two leaves its error in the stronger half, and so do parameters
/// that are wrong by chance: a start that no solver has touched. No sign tells those two apart.
///
/// None where the result cannot be a start (a point behind it, a reflection, another picture size, a lens of
/// more than 14 numbers), or the solve does not end.
std::optional<Resolved> resolve_from(const ScoreRig& result, const Probe& probe,
                                     const Correspondences& decoded = {});

}  // namespace laterna
