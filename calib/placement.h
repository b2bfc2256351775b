// A device whose intrinsics are known: only where it stands is sought.
#pragma once

#include "calib/candidates.h"

namespace laterna {

/// The prior that known intrinsics are: exact values get sigmas far below what pixels tell and far above
/// rounding.
IntrinsicsPrior prior_of(const KnownIntrinsics& known);

/// The best placement for correspondences as solve() finds it, without its covariance and verdict;
/// device_from_points is device_from_world. `refusal` also where the points are degenerate.
BestRefinement place(const Correspondences& correspondences, const KnownIntrinsics& known,
                     const RobustLoss& loss = {});

}  // namespace laterna
