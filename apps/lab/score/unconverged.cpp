#include "apps/lab/score/unconverged.h"

#include "calib/error_directions.h"
#include "calib/refine.h"

#include <cmath>
#include <numeric>

namespace laterna {

namespace {

constexpr double weak_share = 0.9;

bool is_near(double a, double b) { return std::abs(a - b) < 1e-6; }

bool is_nominal(const Intrinsics& k, const Intrinsics& truth) {
  const glm::dvec2 size(k.size);
  const auto middle = [](double c, double n) { return is_near(c, (n - 1) / 2) || is_near(c, n / 2); };
  const double off = std::max({std::abs(k.fx - truth.fx), std::abs(k.fy - truth.fy),
                               std::abs(k.cx - truth.cx), std::abs(k.cy - truth.cy)});
  return is_near(k.fx, k.fy) && middle(k.cx, size.x) && middle(k.cy, size.y) && off > 1;
}

bool is_stopped(const Device& truth, const Device& projector, const Probe& probe) {
  const WorldProjection projection(projector);
  std::vector<glm::dvec2> errors;
  errors.reserve(probe.points_world.size());
  for (std::size_t i = 0; i < probe.points_world.size(); ++i)
    errors.push_back(glm::dvec2(projection.project(probe.points_world[i])) - probe.true_pixels[i]);
  const std::vector<double> shares = error_directions(truth, probe.points_world, errors);
  const auto half = shares.begin() + std::ptrdiff_t(shares.size() / 2);
  return std::accumulate(half, shares.end(), 0.0) > weak_share;
}

}  // namespace

std::optional<Resolved> resolve_from(const ScoreRig& result, const Probe& probe) {
  const auto projector = align(result, probe.truth, probe.alignment);
  const Device& truth = probe.truth.projector;
  if (!projector || projector->lens.model != truth.lens.model ||
      projector->intrinsics.size != truth.intrinsics.size ||
      glm::determinant(projector->device_from_world.rotation) < 0)
    return std::nullopt;
  Correspondences exact;
  exact.world_points.assign(probe.points_world.begin(), probe.points_world.end());
  exact.projector_pixels.assign(probe.true_pixels.begin(), probe.true_pixels.end());
  exact.sigma_px.assign(probe.points_world.size(), 1.0);
  const WorldNormalisation normalisation = normalisation_of(exact.world_points);
  ProjectorState start = state_of(*projector);
  start.device_from_points = device_from_normalised(start.device_from_points, normalisation);
  const auto end = refine(point_table(exact, normalisation), LensGradient(truth.lens.model), start, {});
  if (!end) return std::nullopt;
  return Resolved{end->loss / double(exact.world_points.size()), is_stopped(truth, *projector, probe),
                  is_nominal(projector->intrinsics, truth.intrinsics)};
}

}  // namespace laterna
