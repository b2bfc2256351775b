// Starts that need no good relief: a few nominal focal lengths, each with its best pose.
#pragma once

#include "calib/projection_rows.h"

#include <vector>

namespace laterna {

/// For f = 0.5, 1, 2, 5 and 15 times the width, with the principal point at the image's centre: the pose by
/// OpenCV's SQPNP from at most 500 evenly spread points (Terzakis and Lourakis, ECCV 2020). Only poses with
/// every used point in front are returned. `points` in their own frame.
std::vector<ProjectorState> nominal_starts(const PointTable& points, glm::ivec2 size, int lens_parameters);

}  // namespace laterna
