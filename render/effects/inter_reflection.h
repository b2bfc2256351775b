// Light that reaches a surface by way of others: diffuse paths, one per pixel of a region, a bounce at a
// time.
//
// Luminance at the camera from k diffuse bounces, with E(y) the projector's direct illuminance at y, a the
// albedo of what is met, and a path x → y1 → y2 → ... that leaves each point in a cosine-distributed
// direction:
//   L(x) = a(x)/π · mean over paths of Σ_{j=1..k} a(y1)·...·a(yj) · E(yj).
// Each term is an entry at the projector pixel that lights yj. Paths do not depend on the pattern, so that
// they are traced once for a whole stack. Every path is followed for k bounces, without Russian roulette: k
// is small, and rows stay short by paths, not by chance (Kajiya, "The rendering equation", 1986).
//
// What the model leaves out: gloss, of either end; light through the back of a surface. Ambient light comes
// from everywhere as it is, and is not reflected again.
#pragma once

#include "render/surface.h"

#include <cstdint>

namespace laterna {

/// Which of a pixel's paths, and which step of it.
struct PathStep {
  std::uint64_t seed = 0;
  std::uint32_t camera = 0;
  int sample = 0;           ///< of the pixel
  int path = 0, paths = 1;  ///< of the sample
  int bounce = 0;           ///< 0: the first
};

/// Two numbers in (0, 1), from Threefry4x32-20 with counter (pixel, sample, path, bounce) under the key
/// (seed, camera). For the first bounce each path has a cell of its own of the unit square (cells(), of
/// render/pixel_samples.h).
glm::dvec2 path_numbers(const PathStep& step, const glm::ivec2& pixel);

/// A unit vector whose density is cos θ/π about the unit vector `normal`, for uniform numbers in [0, 1)²:
/// sin²θ = numbers.x, azimuth 2π·numbers.y.
glm::dvec3 cosine_direction(const glm::dvec3& normal, const glm::dvec2& numbers);

/// Moves each pixel's path one bounce on, in place: from the surface point in `paths` to the one that it sees
/// in a cosine-distributed direction about its normal (a normal map's, where that is on), on the side that
/// the path came from. The new point's albedo, with maps and solid albedo, multiplies `paths.albedo`, which
/// so is the path's throughput. A path ends (no_hit) where it meets nothing or has no throughput left: at a
/// back side, say. A ray starts RayScene's margin above its triangle; its hit is refined in double as a
/// camera ray's is. depth_m becomes the length of the step.
void follow_paths(const RayScene& rays, const Scene& scene, const PathStep& step, SurfaceMap& paths);

}  // namespace laterna
