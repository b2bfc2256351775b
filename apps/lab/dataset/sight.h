// What a rig sees of its own light, and when that is too little for a sample.
#pragma once

#include "apps/lab/dataset/dataset_spec.h"
#include "apps/lab/simulation.h"

#include <string>
#include <vector>

namespace laterna {

/// Of one camera and one projector, at pixel centres.
struct Sight {
  double seen = 0;       ///< share of the camera's pixels that see a surface
  double lit = 0;        ///< share of the camera's pixels that see the projector's light
  double projector = 0;  ///< share of the projector's picture, in cells of 8×8 pixels, that is seen
};
Sight sight_of(const Scene& scene, const Traced& traced, const View& view);

/// Why a sample is thrown away, by the first view that is too poor; empty where it is kept:
///
///   nothing_seen               no camera pixel sees a surface
///   no_overlap                 none sees the projector's light
///   too_little_lit             fewer than least_lit of the camera's pixels see it
///   too_little_of_projector    less than least_projector of the projector's picture is seen
std::string rejection(const std::vector<Sight>& views, const RejectSettings& reject);

}  // namespace laterna
