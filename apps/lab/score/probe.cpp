#include "apps/lab/score/probe.h"

#include "calib/correspondences.h"
#include "calib/verify.h"
#include "sim/error.h"
#include "sim/resample.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace laterna {

Probe make_probe(const ScoreRig& truth, const Alignment& alignment,
                 std::span<const glm::dvec3> surface_points) {
  const Device& device = truth.projector;
  const std::vector<double> depths = depths_of(device, surface_points);
  if (depths.empty()) throw InputError("no surface point lies in front of the true projector, expected some");
  Probe probe{truth, alignment};
  probe.diagonal_px = glm::length(glm::dvec2(device.intrinsics.size));
  std::vector<glm::dvec3> points = image_grid(device, volume_depths(depths));
  const std::size_t volume_points = points.size();
  for (const std::size_t i : evenly_spread(surface_points.size(), 2000)) points.push_back(surface_points[i]);
  const WorldProjection projection(device);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == volume_points) probe.surface_begin = probe.points_world.size();
    const glm::dvec2 pixel(projection.project(points[i]));
    if (!std::isfinite(pixel.x + pixel.y)) continue;
    probe.points_world.push_back(points[i]);
    probe.true_pixels.push_back(pixel);
  }
  return probe;
}

glm::dvec2 stretched(const glm::dvec2& pixel, glm::ivec2 from, glm::ivec2 to) {
  const glm::dvec2 scale = glm::dvec2(to) / glm::dvec2(from);
  return {resampled_place_px(pixel.x, scale.x), resampled_place_px(pixel.y, scale.y)};
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

std::vector<glm::dvec2> quick_pixels(const Device& device, std::span<const glm::dvec3> points_world) {
  const LensGradient lens(device.lens.model);
  const Intrinsics& k = device.intrinsics;
  std::vector<double> parameters{k.fx, k.fy, k.cx, k.cy};
  parameters.insert(parameters.end(), device.lens.parameters.begin(), device.lens.parameters.end());
  std::vector<glm::dvec2> pixels(points_world.size(), glm::dvec2(std::numeric_limits<double>::quiet_NaN()));
  double pixel[2];
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (lens.project(parameters, apply(device.device_from_world, points_world[i]), pixel, nullptr, nullptr))
      pixels[i] = {pixel[0], pixel[1]};
  return pixels;
}

std::vector<glm::dvec2> result_pixels(const ScoreRig& result, const Probe& probe) {
  const auto projector = align(result, probe.truth, probe.alignment);
  if (!projector)
    return std::vector<glm::dvec2>(probe.points_world.size(),
                                   glm::dvec2(std::numeric_limits<double>::quiet_NaN()));
  std::vector<glm::dvec2> pixels = quick_pixels(*projector, probe.points_world);
  const glm::ivec2 from = projector->intrinsics.size, to = probe.truth.projector.intrinsics.size;
  if (from != to)
    for (glm::dvec2& pixel : pixels) pixel = stretched(pixel, from, to);
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
