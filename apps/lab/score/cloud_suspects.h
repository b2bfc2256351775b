// Which of the usual mistakes explains a cloud of points that is not where it should be.
#pragma once

#include "apps/lab/score/cloud_errors.h"
#include "apps/lab/score/score_rig.h"
#include "apps/lab/score/suspects.h"
#include "sim/scene.h"

#include <string>
#include <vector>

namespace laterna {

/// What the E of cloud_score.h is made of.
struct CloudScale {
  double noise_m = 0, noise_px = 0, most_m = 0, surface_spread_m = 0;
};

struct CloudSuspects {
  std::vector<Suspect> suspects{};
  std::string better_frame{};
};

/// See score_cloud(). `points` as the options' frame has them, not yet aligned.
CloudSuspects cloud_suspects(const Scene& scene, const CloudGround& ground,
                             const std::vector<CloudPoint>& points, const Alignment& alignment,
                             const CloudScale& scale);

/// The median distance from the middle (the median of each coordinate).
double spread_m(const std::vector<glm::dvec3>& points);

}  // namespace laterna
