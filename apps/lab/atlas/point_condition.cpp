#include "apps/lab/atlas/point_condition.h"

#include "calib/covariance.h"
#include "calib/refine.h"
#include "calib/verify.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace laterna {

namespace {

constexpr double distance_m = 2;
constexpr double least_sigma_px = 1e-3;
const glm::ivec2 size(1280, 800);

/// Draws that are the same on every platform.
struct Draws {
  std::mt19937_64 random;
  double uniform() { return (double(random() >> 11) + 0.5) * 0x1p-53; }
  double normal() {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
};

[[noreturn]] void unknown(const char* key, const std::string& word, const char* expected) {
  throw InputError(fmt::format("{} is \"{}\", expected {}", key, word, expected));
}

Device true_projector(const PointCondition& c, Draws& draws) {
  const double f = size.x / 2.0 / std::tan(glm::radians(c.throw_deg) / 2);
  double roll = 0;
  if (c.orientation == "portrait")
    roll = 90;
  else if (c.orientation == "upside_down")
    roll = 180;
  else if (c.orientation != "landscape" && c.orientation != "mirrored")
    unknown("orientation", c.orientation, "landscape, portrait, upside_down or mirrored");
  Device d;
  d.name = "projector";
  d.intrinsics = {size, f, 1.003 * f, size.x * (0.48 + 0.04 * draws.uniform()), size.y * (0.5 + c.shift)};
  if (c.true_k1 != 0) d.lens = {"LENSMODEL_OPENCV4", {c.true_k1, 0, 0, 0}};
  const glm::dvec3 turn(0.4 * draws.uniform() - 0.2, 0.4 * draws.uniform() - 0.2, glm::radians(roll));
  const glm::dmat3 rotation = rigid_from_rotation_vector({0, 0, turn.z}, {}).rotation *
                              rigid_from_rotation_vector({turn.x, turn.y, 0}, {}).rotation;
  const glm::dvec3 centre =
      glm::dvec3(0.3, -0.2, 0.1) + c.world_offset_m * glm::normalize(glm::dvec3(0.7, 0.4, -0.6));
  d.device_from_world = {rotation, -(rotation * centre)};
  return d;
}

glm::dvec2 draw_pixel(const PointCondition& c, Draws& draws) {
  const double u = draws.uniform(), v = draws.uniform();
  return {u * c.overlap * size.x - 0.5, v * c.overlap * size.y - 0.5};
}

// The depth along the axis at which a ray (x/z, y/z, 1) meets a plane that stands at 2 m on the picture's
// middle ray.
double plane_depth(const glm::dvec3& ray, const glm::dvec3& middle, double grazing_deg) {
  const double slope = 1 / std::tan(glm::radians(grazing_deg));  // dz over dx
  const double z = distance_m / std::max(0.05, 1 - slope * (ray.x - middle.x));
  return std::min(z, 40 * distance_m);
}

// The point of one pixel's ray, in the device's frame; `k` counts points.
glm::dvec3 point_on(const PointCondition& c, int k, const glm::dvec3& ray, const glm::dvec3& middle,
                    Draws& draws) {
  const double off = c.relief * distance_m * (draws.uniform() - 0.5);
  if (c.shape == "slab") return ray * (plane_depth(ray, middle, c.grazing_deg) + off);
  if (c.shape == "two_planes") {
    const glm::dvec3 other(2 * middle.x - ray.x, ray.y, 1);
    return ray * (plane_depth(k % 2 ? other : ray, middle, c.grazing_deg) + off);
  }
  if (c.shape == "plane_and_line") {
    if (k % 2) return ray * (plane_depth(ray, middle, c.grazing_deg) + off);
    const glm::dvec3 near_ray(middle.x + c.relief * (ray.x - middle.x),
                              middle.y + c.relief * (ray.y - middle.y), 1);
    return near_ray * (distance_m * (0.7 + 0.6 * draws.uniform()));
  }
  if (c.shape == "twisted_cubic") {
    const double t = 0.3 + 0.7 * draws.uniform(), half = std::tan(glm::radians(c.throw_deg) / 2);
    const glm::dvec2 at = glm::dvec2(middle) + half * glm::dvec2(1.4 * t - 0.9, 0.8 * t * t - 0.4);
    const glm::dvec2 beside = glm::dvec2(ray - middle) * c.relief;
    return glm::dvec3(at + beside, 1.0) * (1.4 * distance_m * t);
  }
  unknown("shape", c.shape, "slab, two_planes, plane_and_line or twisted_cubic");
}

void disturb(const PointCondition& c, PointProblem& problem, Draws& draws) {
  for (glm::dvec2& pixel : problem.correspondences.projector_pixels) {
    pixel.x += c.noise_px * draws.normal(), pixel.y += c.noise_px * draws.normal();
    if (draws.uniform() < c.outliers)
      pixel = {draws.uniform() * size.x - 0.5, draws.uniform() * size.y - 0.5};
    if (c.orientation == "mirrored") pixel.x = size.x - 1 - pixel.x;
    pixel.x += c.shift_u_px;
  }
  const glm::dvec3 origin = problem.correspondences.world_points.empty()
                                ? glm::dvec3(0.0)
                                : problem.correspondences.world_points[0];
  for (glm::dvec3& x : problem.correspondences.world_points) x = origin + c.world_scale * (x - origin);
}

}  // namespace

PointProblem point_problem(const PointCondition& c, std::uint64_t seed) {
  Draws draws{std::mt19937_64(seed)};
  PointProblem problem{true_projector(c, draws), {}, {}};
  const WorldProjection projection(problem.truth);
  const LensProjection lens(problem.truth.intrinsics, problem.truth.lens);
  const Rigid world_from_device = inverse(problem.truth.device_from_world);
  const auto middle = lens.unproject({(size.x - 1) / 2.0, (size.y - 1) / 2.0});
  const double sigma = std::max(c.noise_px, least_sigma_px);
  for (int k = 0; k < c.points; ++k) {
    const auto ray = lens.unproject(draw_pixel(c, draws));
    if (!ray || !middle) continue;
    const glm::dvec3 x = apply(world_from_device, point_on(c, k, *ray / ray->z, *middle / middle->z, draws));
    const glm::dvec3 pixel = projection.project(x);
    if (!std::isfinite(pixel.x) || !(pixel.z > 0)) continue;
    problem.correspondences.world_points.push_back(x);
    problem.correspondences.projector_pixels.emplace_back(pixel.x, pixel.y);
    problem.correspondences.sigma_px.push_back(sigma);
  }
  problem.lit_points = problem.correspondences.world_points;
  disturb(c, problem, draws);
  return problem;
}

double volume_bound_px(const PointProblem& problem, const PointCondition& c) {
  Device model = problem.truth;
  if (c.lens == "opencv4" && model.lens.model == "LENSMODEL_PINHOLE")
    model.lens = {"LENSMODEL_OPENCV4", {0, 0, 0, 0}};
  if (c.lens == "pinhole" && model.lens.model != "LENSMODEL_PINHOLE") return NAN;
  Correspondences clean = problem.correspondences;
  clean.world_points = problem.lit_points;
  const WorldNormalisation n = normalisation_of(clean.world_points);
  ProjectorState state = state_of(model);
  state.device_from_points = device_from_normalised(model.device_from_world, n);
  const PointTable points = point_table(clean, n);
  const LensGradient lens(model.lens.model);
  const auto factor = row_factor(points, lens, state, {});
  if (!factor) return NAN;
  const auto singular = scaled_spectrum(*factor, lens.parameter_count() + 6).singular_values;
  if (!(singular.back() > 1e-13 * singular.front())) return NAN;  // as solve() has it
  const auto covariance = ceres_covariance(points, lens, state, {{}, 0, double(size.x)}, *factor);
  if (!covariance) return NAN;
  const auto volume = image_grid(model, volume_depths(depths_of(model, problem.lit_points)));
  return predicted_rms(model, world_covariance(*covariance, model.device_from_world, n), volume)
      .value_or(NAN);
}

}  // namespace laterna
