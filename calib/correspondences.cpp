#include "calib/correspondences.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

void validate_cameras(const Correspondences& c) {
  const std::size_t n = c.cameras.empty() ? 0 : c.world_points.size();
  if (c.camera.size() != n || c.normals_world.size() != n) {
    throw InputError(
        fmt::format("correspondences: {} camera ids and {} normals for {} uncertain cameras, expected {} of "
                    "each",
                    c.camera.size(), c.normals_world.size(), c.cameras.size(), n));
  }
  for (const UncertainCamera& camera : c.cameras) {
    const std::size_t p = camera.device.lens.parameters.size() + 10;
    const bool finite = std::all_of(camera.covariance.begin(), camera.covariance.end(),
                                    [](double x) { return std::isfinite(x); });
    if (finite && (camera.covariance.empty() || camera.covariance.size() == p * p)) continue;
    throw InputError(fmt::format("camera \"{}\": a covariance of {} numbers, expected {}×{} finite ones",
                                 camera.device.name, camera.covariance.size(), p, p));
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (c.camera[i] >= c.cameras.size())
      throw InputError(fmt::format("correspondence {}: camera {} of {}", i, c.camera[i], c.cameras.size()));
    if (!(std::abs(glm::length(c.normals_world[i]) - 1) < 1e-6))
      throw InputError(fmt::format("correspondence {}: a normal of length {}, expected 1", i,
                                   glm::length(c.normals_world[i])));
  }
}

}  // namespace

void validate(const Correspondences& c) {
  const std::size_t n = c.world_points.size();
  if (c.projector_pixels.size() != n || c.sigma_px.size() != n ||
      (!c.cluster.empty() && c.cluster.size() != n)) {
    throw InputError(
        fmt::format("correspondences: {} world points, {} projector pixels, {} sigmas and {} cluster ids, "
                    "expected equally many (cluster ids may be absent)",
                    n, c.projector_pixels.size(), c.sigma_px.size(), c.cluster.size()));
  }
  for (std::size_t i = 0; i < n; ++i) {
    const auto& x = c.world_points[i];
    const auto& p = c.projector_pixels[i];
    if (!std::isfinite(x.x) || !std::isfinite(x.y) || !std::isfinite(x.z) || !std::isfinite(p.x) ||
        !std::isfinite(p.y)) {
      throw InputError(fmt::format(
          "correspondence {}: world point ({}, {}, {}) and pixel ({}, {}), expected finite numbers", i, x.x,
          x.y, x.z, p.x, p.y));
    }
    if (!(c.sigma_px[i] > 0 && std::isfinite(c.sigma_px[i]))) {
      throw InputError(
          fmt::format("correspondence {}: sigma is {} px, expected a positive number", i, c.sigma_px[i]));
    }
  }
  validate_cameras(c);
}

Correspondences subset(const Correspondences& c, const std::vector<std::size_t>& indices) {
  Correspondences chosen;
  chosen.cameras = c.cameras;
  for (const std::size_t i : indices) {
    chosen.world_points.push_back(c.world_points[i]);
    chosen.projector_pixels.push_back(c.projector_pixels[i]);
    chosen.sigma_px.push_back(c.sigma_px[i]);
    if (!c.cluster.empty()) chosen.cluster.push_back(c.cluster[i]);
    if (c.cameras.empty()) continue;
    chosen.camera.push_back(c.camera[i]);
    chosen.normals_world.push_back(c.normals_world[i]);
  }
  return chosen;
}

std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t wanted) {
  std::vector<std::size_t> indices;
  if (count <= wanted) {
    for (std::size_t i = 0; i < count; ++i) indices.push_back(i);
    return indices;
  }
  constexpr double golden = 0.6180339887498949;
  const double step = double(count) / double(wanted);
  for (std::size_t k = 0; k < wanted; ++k) {
    const double jitter = golden * double(k) - std::floor(golden * double(k));
    indices.push_back(std::min(count - 1, std::size_t((double(k) + jitter) * step)));
  }
  return indices;
}

}  // namespace laterna
