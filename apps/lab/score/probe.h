// The points that suspects are tried on, and the error that is left at them.
#pragma once

#include "apps/lab/score/score_rig.h"

#include <functional>
#include <span>
#include <vector>

namespace laterna {

/// World points with the true projector's pixels. Errors are in pixels of the true projector and no larger
/// than its picture's diagonal, which also stands for a point that a result cannot project: farther off than
/// the picture is wide is all the same.
struct Probe {
  ScoreRig truth;
  Alignment alignment;
  std::vector<glm::dvec3> points_world{};
  std::vector<glm::dvec2> true_pixels{};
  std::size_t surface_begin = 0;  ///< points before it are the volume's, from it on the surface's
  double diagonal_px = 0;
};

/// Up to 2,000 of the surface points, evenly spread, and the volume of verify.h. Throws InputError where no
/// surface point lies in front of the true projector.
Probe make_probe(const ScoreRig& truth, const Alignment& alignment,
                 std::span<const glm::dvec3> surface_points);

/// A pixel of a picture of size `from`, at the same share of the width and height of a picture of size `to`:
/// u' = (u + 0.5)·W_to/W_from - 0.5. Results of another picture size are compared so.
glm::dvec2 stretched(const glm::dvec2& pixel, glm::ivec2 from, glm::ivec2 to);

/// The pixels that a result, aligned and stretched, gives to points; NaN where it gives none or cannot be
/// aligned.
std::vector<glm::dvec2> result_pixels(const ScoreRig& result, const ScoreRig& truth,
                                      const Alignment& alignment, std::span<const glm::dvec3> points_world);
/// The same at the probe's points without looking for the lens's fold (sim/lens.h), which takes longer than
/// the points: for trying one mistake after the other.
std::vector<glm::dvec2> result_pixels(const ScoreRig& result, const Probe& probe);
std::vector<glm::dvec2> quick_pixels(const Device& device, std::span<const glm::dvec3> points_world);

/// mean(min(|e|², diagonal²)), px².
double squared_error_px2(std::span<const glm::dvec2> pixels, std::span<const glm::dvec2> true_pixels,
                         double diagonal_px);
inline double squared_error_px2(std::span<const glm::dvec2> pixels, const Probe& probe) {
  return squared_error_px2(pixels, probe.true_pixels, probe.diagonal_px);
}

}  // namespace laterna
