#include "apps/lab/score/unconverged.h"

#include "calib/error_directions.h"
#include "calib/refine.h"

#include <cmath>
#include <numeric>

namespace laterna {

namespace {

constexpr double most_in_one_half = 0.9;
constexpr std::size_t most_points = 3000, most_lens_parameters = 14;

bool is_near(double a, double b) { return std::abs(a - b) < 1e-6; }

bool is_nominal(const Intrinsics& k, const Intrinsics& truth) {
  const glm::dvec2 size(k.size);
  const auto middle = [](double c, double n) { return is_near(c, (n - 1) / 2) || is_near(c, n / 2); };
  const double off = std::max({std::abs(k.fx - truth.fx), std::abs(k.fy - truth.fy),
                               std::abs(k.cx - truth.cx), std::abs(k.cy - truth.cy)});
  return is_near(k.fx, k.fy) && middle(k.cx, size.x) && middle(k.cy, size.y) && off > 1;
}

// The error's shares in the stronger and the weaker half of the directions.
std::pair<double, double> halves(const Device& projector, const Probe& probe) {
  std::vector<glm::dvec2> errors = quick_pixels(projector, probe.points_world);
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] -= probe.true_pixels[i];
  const std::vector<double> shares = error_directions(probe.truth.projector, probe.points_world, errors);
  const auto half = shares.begin() + std::ptrdiff_t(shares.size() / 2);
  return {std::accumulate(shares.begin(), half, 0.0), std::accumulate(half, shares.end(), 0.0)};
}

Correspondences true_points(const Probe& probe) {
  Correspondences exact;
  exact.world_points.assign(probe.points_world.begin(), probe.points_world.end());
  exact.projector_pixels.assign(probe.true_pixels.begin(), probe.true_pixels.end());
  exact.sigma_px.assign(probe.points_world.size(), 1.0);
  return exact;
}

std::optional<Device> solved_from(const Device& start, const Correspondences& points) {
  const WorldNormalisation normalisation = normalisation_of(points.world_points);
  ProjectorState state = state_of(start);
  state.device_from_points = device_from_normalised(state.device_from_points, normalisation);
  const auto end = refine(point_table(points, normalisation), LensGradient(start.lens.model), state, {});
  if (!end) return std::nullopt;
  Device device = start;
  const std::vector<double>& p = end->state.parameters;
  device.intrinsics = {start.intrinsics.size, p[0], p[1], p[2], p[3]};
  device.lens.parameters.assign(p.begin() + 4, p.end());
  device.device_from_world = device_from_world(end->state.device_from_points, normalisation);
  return device;
}

}  // namespace

std::optional<Resolved> resolve_from(const ScoreRig& result, const Probe& probe,
                                     const Correspondences& decoded) {
  auto start = align(result, probe.truth, probe.alignment);
  const Device& truth = probe.truth.projector;
  if (!start || start->intrinsics.size != truth.intrinsics.size ||
      start->lens.parameters.size() > most_lens_parameters ||
      glm::determinant(start->device_from_world.rotation) < 0)
    return std::nullopt;
  Resolved resolved;
  resolved.is_nominal_start = is_nominal(start->intrinsics, truth.intrinsics);
  const auto [strong, weak] = halves(*start, probe);
  resolved.is_stopped_descent = weak > most_in_one_half;
  resolved.is_like_noise = weak <= most_in_one_half && strong <= most_in_one_half;
  if (resolved.is_nominal_start && is_pinhole(start->lens) &&
      truth.lens.parameters.size() <= most_lens_parameters)
    start->lens = {truth.lens.model, std::vector<double>(truth.lens.parameters.size(), 0.0)};
  const std::size_t points = decoded.world_points.size();
  const auto end =
      solved_from(*start, points ? subset(decoded, evenly_spread(points, most_points)) : true_points(probe));
  if (!end) return std::nullopt;
  resolved.remaining_px2 = squared_error_px2(quick_pixels(*end, probe.points_world), probe);
  return resolved;
}

}  // namespace laterna
