// Who is named for what: mistakes planted in pictures of random rigs, calibrated by two solvers.
#pragma once

#include "tests/lab/score/confusion.h"

#include <cstdint>
#include <vector>

namespace laterna::testing {

/// Plants every mistake of picture_mistakes.h once in a capture of each of `rigs` random rigs
/// (picture_scenes.h), whose right captures Laterna's own trial is content with. What was spoilt is written
/// as a capture folder, decoded, calibrated by Laterna and by OpenCV (calib/peers/point_methods.h), each
/// result told by a file of some format, and scored against the folder. `shows`: the status is not ok.
std::vector<Verdict> picture_verdicts(int rigs, std::uint64_t seed);

}  // namespace laterna::testing
