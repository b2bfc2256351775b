// The usual mistakes, each in several of the ways in which people make it, to be planted in a right result.
#pragma once

#include "tests/lab/score/random_rigs.h"

#include <functional>
#include <string>
#include <vector>

namespace laterna::testing {

/// A mistake and one way to make it. `make` edits the result's projector, or all of its devices.
struct Planted {
  std::string suspect, how;
  std::function<void(Rig& result, const CalibratedRig& rig, std::mt19937_64& random)> make;
};

/// Of all suspects that a result's numbers alone can show: all but gamma and dropped_frame.
std::vector<Planted> planted_mistakes();

/// Two of them, one after the other, of those that nothing need be measured for.
Planted two_mistakes(std::mt19937_64& random);

/// What a solver has after `iterations` from a start that is off as guesses are: nominal focal lengths, the
/// picture's middle, a placement some degrees and a tenth of the distance off. None where it cannot start.
Device stopped_solve(const CalibratedRig& rig, int iterations, std::mt19937_64& random);

}  // namespace laterna::testing
