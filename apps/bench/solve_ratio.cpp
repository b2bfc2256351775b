#include "apps/bench/solve_ratio.h"

#include "apps/bench/timing.h"
#include "calib/projection_rows.h"
#include "calib/solve.h"

#include <cmath>
#include <random>
#include <stdexcept>

namespace laterna {

namespace {

constexpr std::size_t count = 1000000;
constexpr double sigma_px = 0.3;

Device true_projector() {
  Device device;
  device.intrinsics = {{1280, 800}, 1500, 1505, 640, 760};
  device.device_from_world = device_from_world_looking_at({0.2, -0.1, -2}, {0, 0, 0}, {0, -1, 0});
  return device;
}

Correspondences bumpy_surface(const Device& projector) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> across(-0.4, 0.4), depth(-0.15, 0.15);
  std::normal_distribution<double> noise(0, sigma_px);
  const ProjectorState state = state_of(projector);
  const LensGradient lens(projector.lens.model);
  Correspondences c;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 x(across(random), across(random), depth(random));
    double pixel[2];
    if (!project_with_rows(lens, state, x, pixel, nullptr))
      throw std::runtime_error("a point lies behind the projector");
    c.world_points.push_back(x);
    c.projector_pixels.emplace_back(pixel[0] + noise(random), pixel[1] + noise(random));
    c.sigma_px.push_back(sigma_px);
    const auto block = [](double v) { return std::uint32_t((v + 0.4) / 0.8 * 50); };
    c.cluster.push_back(block(x.y) * 50 + block(x.x));
  }
  return c;
}

}  // namespace

SolveTimes time_solve(int repeats) {
  const Device truth = true_projector();
  const Correspondences c = bumpy_surface(truth);
  const WorldNormalisation normalisation = normalisation_of(c.world_points);
  const PointTable points = point_table(c, normalisation);
  ProjectorState state = state_of(truth);
  state.device_from_points = device_from_normalised(state.device_from_points, normalisation);
  const LensGradient lens(truth.lens.model);
  std::vector<double> ratios, times;
  SolveTimes result;
  for (int i = -1; i < repeats; ++i) {  // the first round warms up
    const double pass = seconds([&] { row_factor(points, lens, state, {}); });
    SolveResult solved;
    const double whole = seconds([&] { solved = solve(c, truth.intrinsics.size); });
    if (solved.status != Status::ok) throw std::runtime_error("a million points: " + solved.reason);
    result.passes = solved.iterations + 2;
    if (i >= 0) ratios.push_back(whole / pass), times.push_back(whole);
  }
  result.over_pass = median(ratios), result.seconds = median(times);
  return result;
}

}  // namespace laterna
