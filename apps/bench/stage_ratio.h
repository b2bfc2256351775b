// What the visibility stage costs beside the same rays through bare Embree calls.
#pragma once

#include "sim/scene.h"

#include <string>

namespace laterna {

/// The scene that the figures are made on: a relief of about `triangles` triangles, a 1280×800 camera and a
/// 1280×800 projector that both look at it.
Scene bench_scene(int triangles);

/// Embree's way of taking rays.
struct BareWay {
  int width = 16;        ///< 8 or 16
  bool coherent = true;  ///< RTC_INTERSECT_CONTEXT_FLAG_COHERENT
  bool robust = false;   ///< RTC_SCENE_FLAG_ROBUST
};
std::string describe(const BareWay& way);

/// Median seconds over `repeats`.
struct VisibilityTimes {
  double visibility = 0;  ///< camera rays, hits refined in double, projection, shadow, region by region as in
                          ///< laterna capture, into the maps that rows are made of
  double bare = 0;   ///< the same camera rays and the same shadow rays, ready in memory, and nothing else
  double rays = 0;   ///< how many: camera rays and shadow rays
  double ratio = 0;  ///< median of visibility/bare within each repeat
};

/// Times both in turn, in the same run, with the threads that are set.
VisibilityTimes visibility_over_embree(const Scene& scene, const BareWay& way, int repeats);

}  // namespace laterna
