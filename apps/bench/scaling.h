// How the time of a capture grows with patterns, samples and bounces.
#pragma once

#include "sim/scene.h"

#include <string>
#include <vector>

namespace laterna {

/// One capture: rays, rows, replay and exposure of `patterns` 8-bit patterns, bilinear, in memory.
struct ScalingPoint {
  std::string axis;  ///< "patterns", "samples", "bounces" or "paths": which number this series changes
  int patterns = 44, samples = 1, bounces = 0, paths = 0;
  double entries_per_pixel = 0, seconds = 0;

  int value() const;  ///< the number that `axis` names
};

/// Four series, each along one axis, of what `scene` is with walls 4 m about the origin, so that every path
/// goes on; seconds are medians over `repeats`, the scene's rays being ready. The patterns are those of a
/// Gray sequence, over and over.
std::vector<ScalingPoint> time_scaling(Scene scene, int repeats);

/// Seconds as a + b·value by least squares over a series, and the largest relative distance from it.
struct StraightLine {
  double seconds_at_0 = 0, seconds_per_step = 0, largest_misfit = 0;
};
StraightLine straight_line(const std::vector<ScalingPoint>& series);

/// A header and a line per point: axis,patterns,samples,bounces,paths,entries_per_pixel,seconds.
std::string scaling_csv(const std::vector<ScalingPoint>& points);

/// One plot per axis, side by side: points, the straight line through them, and its equation.
std::string scaling_svg(const std::vector<ScalingPoint>& points);

}  // namespace laterna
