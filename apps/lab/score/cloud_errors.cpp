#include "apps/lab/score/cloud_errors.h"

#include "calib/correspondences.h"
#include "sim/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace laterna {

namespace {

constexpr std::size_t block = 1024, most_aligned = 20'000;
constexpr double beyond_any_m = 1e30;  // sums of squares stay numbers
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Calls part(first, last) for blocks of [0, count), on several threads.
template <class Part>
void in_blocks(std::size_t count, const Part& part) {
  parallel_for((count + block - 1) / block,
               [&](std::size_t b) { part(b * block, std::min(count, (b + 1) * block)); });
}

glm::dvec3 ray_of(const WorldProjection& projection, const glm::dvec3& centre_world, glm::ivec2 size,
                  const glm::dvec2& pixel) {
  const bool is_inside =
      pixel.x >= -0.5 && pixel.y >= -0.5 && pixel.x <= size.x - 0.5 && pixel.y <= size.y - 0.5;
  const auto x = is_inside ? projection.unproject(pixel, 1) : std::nullopt;
  return x ? glm::normalize(*x - centre_world) : glm::dvec3(nan);
}

std::vector<double> finite(std::span<const double> errors) {
  std::vector<double> values;
  std::copy_if(errors.begin(), errors.end(), std::back_inserter(values),
               [](double e) { return std::isfinite(e); });
  return values;
}

// Also where it is NaN, as of a difference of infinities.
double capped(double error, double most) { return error < most ? error : most; }

}  // namespace

std::vector<glm::dvec3> true_points(const CloudGround& ground, std::span<const CloudPoint> points) {
  const bool by_camera = ground.camera.has_value();
  const std::optional<Device>& device = by_camera ? ground.camera : ground.projector;
  if (!device) return {};
  std::vector<glm::dvec3> result(points.size());
  const WorldProjection projection(*device);
  const glm::dvec3 centre_world = center_in_world(device->device_from_world);
  in_blocks(points.size(), [&](std::size_t first, std::size_t last) {
    std::vector<glm::dvec3> rays;
    for (std::size_t i = first; i < last; ++i)
      rays.push_back(ray_of(projection, centre_world, device->intrinsics.size,
                            by_camera ? points[i].camera_px : points[i].projector_px));
    const std::vector<glm::dvec3> hits = ground.surface->first_points(centre_world, rays);
    std::copy(hits.begin(), hits.end(), result.begin() + std::ptrdiff_t(first));
  });
  return result;
}

CloudErrors cloud_errors(const CloudGround& ground, std::span<const CloudPoint> points,
                         std::span<const glm::dvec3> true_points) {
  CloudErrors errors;
  errors.surface_m.resize(points.size());
  errors.point_m.resize(true_points.size());
  std::optional<WorldProjection> projector;
  double diagonal_px = 0;
  if (ground.projector) {
    projector.emplace(*ground.projector);
    diagonal_px = glm::length(glm::dvec2(ground.projector->intrinsics.size));
    errors.projector_px.resize(points.size());
  }
  in_blocks(points.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const CloudPoint& p = points[i];
      errors.surface_m[i] = ground.surface->distance_m(p.x_world, ground.farthest_m);
      if (!true_points.empty())
        errors.point_m[i] = std::isnan(true_points[i].x)
                                ? nan
                                : capped(glm::distance(p.x_world, true_points[i]), ground.farthest_m);
      if (projector)
        errors.projector_px[i] =
            capped(glm::distance(glm::dvec2(projector->project(p.x_world)), p.projector_px), diagonal_px);
    }
  });
  return errors;
}

std::optional<Similarity> aligned_to(std::span<const CloudPoint> points,
                                     std::span<const glm::dvec3> true_points,
                                     const SimilarityOptions& options) {
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < true_points.size(); ++i)
    if (!std::isnan(true_points[i].x) && glm::length(points[i].x_world) < beyond_any_m) usable.push_back(i);
  std::vector<glm::dvec3> a, b;
  for (const std::size_t k : evenly_spread(usable.size(), most_aligned))
    a.push_back(points[usable[k]].x_world), b.push_back(true_points[usable[k]]);
  return fit_similarity(a, b, options);
}

double rms_of(std::span<const double> errors) {
  const std::vector<double> values = finite(errors);
  double sum = 0;
  for (const double e : values) sum += e * e;
  return values.empty() ? nan : std::sqrt(sum / double(values.size()));
}

double quantile_of(std::span<const double> errors, double share) {
  std::vector<double> values = finite(errors);
  if (values.empty()) return nan;
  const auto at = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace laterna
