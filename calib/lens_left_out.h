// Do the residuals of a pinhole follow a lens?
#pragma once

#include "calib/projection_rows.h"

#include <optional>

namespace laterna {

/// What k1, k2, p1, p2 (LENSMODEL_OPENCV4) would change where they were left out.
struct LensLeftOut {
  Device device;  ///< the estimate with them, by one Gauss-Newton step; in the world
  double wald = 0;  ///< kᵀ·C⁻¹·k of the four terms: χ² with four degrees of freedom where there is no lens
};

/// The test of Wald on the step from a pinhole's optimum, all other parameters moving along. C is the
/// covariance of independent noise scaled to the residuals, or the clustered one (covariance.h), whichever
/// gives the smaller value. `state` is the pinhole in the points' normalised frame; `size` its image. None
/// where the points do not determine the larger model. Where the first value is below `least_wald` already,
/// the second is not sought.
std::optional<LensLeftOut> lens_left_out(const PointTable& points, const ProjectorState& state,
                                         const RobustLoss& loss, const WorldNormalisation& normalisation,
                                         glm::ivec2 size, double least_wald = 0);

}  // namespace laterna
