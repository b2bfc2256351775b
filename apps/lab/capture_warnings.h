// What a person should know before taking a capture's pictures for good.
#pragma once

#include "apps/lab/simulation.h"

#include <string>
#include <vector>

namespace laterna {

/// One sentence for each view whose projector is so far out of focus that the median blur disc, over every
/// eighth strip of lit pixels, is wider than the finest stripes of the Gray code (2 panel pixels). Empty
/// where nothing is amiss, and for a slide.
std::vector<std::string> capture_warnings(const Scene& scene, const SceneRays& rig);

}  // namespace laterna
