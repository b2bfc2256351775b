// Starts that need no good relief: a few nominal focal lengths, each with its best pose.
#pragma once

#include "calib/projection_rows.h"
#include "sim/lens.h"

#include <vector>

namespace laterna {

/// For f = 0.5, 1, 2, 5 and 15 times the width, with the principal point at the image's centre: the pose by
/// OpenCV's SQPNP from at most 500 evenly spread points (Terzakis and Lourakis, ECCV 2020). Only poses with
/// every used point in front are returned. `points` in their own frame.
std::vector<ProjectorState> nominal_starts(const PointTable& points, glm::ivec2 size, int lens_parameters);

/// Placements of a device whose intrinsics and lens are `known`, from at most 500 evenly spread points: by
/// SQPNP, and both by IPPE (Collins and Bartoli, IJCV 2014) where the points are coplanar; with `robust` from
/// the inliers (5 sigma) of P3P under RANSAC, whose random numbers are OpenCV's own and always the same. Only
/// those with every used point in front.
std::vector<ProjectorState> placement_starts(const PointTable& points, const ProjectorState& known,
                                             const LensProjection& lens, bool coplanar, bool robust);

}  // namespace laterna
