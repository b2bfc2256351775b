// Is the camera of a result right, too? A projector may be right beside a camera that is not.
#pragma once

#include "apps/lab/score/suspects.h"

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace laterna {

/// The rms, over world points before the true camera, of its pixel in the result (aligned: where its world is
/// moved, its camera stands where the true one does, and only intrinsics and lens are judged; stretched,
/// where pictures differ in size) less the true pixel, in pixels of the true camera and no larger than its
/// picture's diagonal (probe.h). NaN where either has no camera, or no point lies before the true one.
double camera_error_px(const ScoreRig& result, const ScoreRig& truth, const Alignment& alignment,
                       std::span<const glm::dvec3> points_world);

/// geometric_suspects() of the camera, whose words say that they are about it. Without `unconverged`: nothing
/// tells how a camera was solved for.
std::vector<Suspect> camera_suspects(const ScoreRig& result, const ScoreRig& truth,
                                     const Alignment& alignment, std::span<const glm::dvec3> points_world);

}  // namespace laterna
