#include "apps/lab/score/probe.h"

#include "calib/correspondences.h"
#include "calib/verify.h"
#include "sim/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace laterna {

Probe make_probe(const ScoreRig& truth, const Alignment& alignment,
                 std::span<const glm::dvec3> surface_points) {
  const Device& device = truth.projector;
  const std::vector<double> depths = depths_of(device, surface_points);
  if (depths.empty()) throw InputError("no surface point lies in front of the true projector, expected some");
  Probe probe{truth, alignment, {}, {}, glm::length(glm::dvec2(device.intrinsics.size))};
  std::vector<glm::dvec3> points = image_grid(device, volume_depths(depths));
  for (const std::size_t i : evenly_spread(surface_points.size(), 2000)) points.push_back(surface_points[i]);
  const WorldProjection projection(device);
  for (const glm::dvec3& x : points) {
    const glm::dvec2 pixel(projection.project(x));
    if (!std::isfinite(pixel.x + pixel.y)) continue;
    probe.points_world.push_back(x);
    probe.true_pixels.push_back(pixel);
  }
  return probe;
}

glm::dvec2 stretched(const glm::dvec2& pixel, glm::ivec2 from, glm::ivec2 to) {
  return (pixel + 0.5) * glm::dvec2(to) / glm::dvec2(from) - 0.5;
}

std::vector<glm::dvec2> result_pixels(const ScoreRig& result, const ScoreRig& truth,
                                      const Alignment& alignment, std::span<const glm::dvec3> points_world) {
  std::vector<glm::dvec2> pixels(points_world.size(), glm::dvec2(std::numeric_limits<double>::quiet_NaN()));
  const auto projector = align(result, truth, alignment);
  if (!projector) return pixels;
  const glm::ivec2 size = truth.projector.intrinsics.size;
  const WorldProjection projection(*projector);
  std::transform(points_world.begin(), points_world.end(), pixels.begin(), [&](const glm::dvec3& x) {
    return stretched(glm::dvec2(projection.project(x)), projector->intrinsics.size, size);
  });
  return pixels;
}

double squared_error_px2(std::span<const glm::dvec2> pixels, std::span<const glm::dvec2> true_pixels,
                         double diagonal_px) {
  const double most = diagonal_px * diagonal_px;
  double sum = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const glm::dvec2 e = pixels[i] - true_pixels[i];
    const double squared = glm::dot(e, e);
    sum += squared < most ? squared : most;  // also where it is NaN
  }
  return sum / double(std::max<std::size_t>(1, pixels.size()));
}

}  // namespace laterna
