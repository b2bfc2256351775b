// Two mistakes at once.
#pragma once

#include "apps/lab/score/probe.h"
#include "apps/lab/score/undo.h"

#include <string>

namespace laterna {

/// Two mistakes, and what undoing both leaves.
struct Pair {
  std::string first, second;  ///< that which explains more alone first
  double remaining_px2 = 0;   ///< squared_error_px2 over the probe
};

/// The two mistakes of different names that leave least: undoings (undo.h) one after the other in either
/// order, or one and then an overscan, which is fitted. Looks at some hundred of the probe's points, and at
/// all of them for the best few.
Pair best_pair(const ScoreRig& result, const Probe& probe);

}  // namespace laterna
