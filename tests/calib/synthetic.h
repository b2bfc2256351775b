// Analytic correspondences with a known projector.
#pragma once

#include "calib/correspondences.h"
#include "calib/verify.h"
#include "sim/device.h"

#include <cmath>
#include <numbers>
#include <random>

namespace laterna::testing {

inline Device projector(glm::ivec2 size, double f, glm::dvec2 principal_point,
                        const Rigid& device_from_world) {
  Device d;
  d.name = "synthetic";
  d.intrinsics = {size, f, f, principal_point.x, principal_point.y};
  d.device_from_world = device_from_world;
  return d;
}

/// A 1280×800 projector of throw 1.5 with some lens shift, turned and away from the origin.
inline Device usual_projector() {
  return projector({1280, 800}, 1920, {650, 700},
                   rigid_from_rotation_vector({0.3, -0.4, 0.1}, {0.2, -0.1, 0.5}));
}

/// The world point of a pixel at a depth, and the pixel that this point has.
inline void add_point(Correspondences& c, const Device& d, const glm::dvec2& pixel, double depth_m,
                      double sigma_px) {
  const WorldProjection projection(d);
  const auto x = projection.unproject(pixel, depth_m);
  if (!x) return;
  c.world_points.push_back(*x);
  c.projector_pixels.push_back(pixel);
  c.sigma_px.push_back(sigma_px);
}

/// n points spread over the whole image and over depths between near_m and far_m.
inline Correspondences scattered(const Device& d, int n, double near_m, double far_m, double sigma_px,
                                 std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const LensProjection lens(d.intrinsics, d.lens);
  const Rigid world_from_device = inverse(d.device_from_world);
  Correspondences c;
  while (int(c.world_points.size()) < n) {
    const glm::dvec2 pixel(uniform(random) * d.intrinsics.size.x - 0.5,
                           uniform(random) * d.intrinsics.size.y - 0.5);
    const double depth = near_m + (far_m - near_m) * uniform(random);
    const auto ray = lens.unproject(pixel);
    if (!ray) continue;
    c.world_points.push_back(apply(world_from_device, *ray * depth));
    c.projector_pixels.push_back(*lens.project(*ray));
    c.sigma_px.push_back(sigma_px);
  }
  return c;
}

/// n points around a plane at depth_m, turned by 0.4 rad about the device's y axis, with a thickness of
/// relief·depth_m.
inline Correspondences near_plane(const Device& d, int n, double depth_m, double relief, double sigma_px,
                                  std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const LensProjection lens(d.intrinsics, d.lens);
  const Rigid world_from_device = inverse(d.device_from_world);
  const glm::dvec3 normal(std::sin(0.4), 0, std::cos(0.4));
  Correspondences c;
  for (int i = 0; i < n; ++i) {
    const glm::dvec2 pixel(uniform(random) * d.intrinsics.size.x - 0.5,
                           uniform(random) * d.intrinsics.size.y - 0.5);
    const glm::dvec3 ray = *lens.unproject(pixel);
    const double along = depth_m * normal.z + relief * depth_m * (uniform(random) - 0.5);
    c.world_points.push_back(apply(world_from_device, ray * (along / glm::dot(normal, ray))));
    c.projector_pixels.push_back(pixel);
    c.sigma_px.push_back(sigma_px);
  }
  return c;
}

/// Gaussian noise of each point's own sigma.
inline void add_noise(Correspondences& c, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < c.projector_pixels.size(); ++i) {
    c.projector_pixels[i].x += c.sigma_px[i] * normal(random);
    c.projector_pixels[i].y += c.sigma_px[i] * normal(random);
  }
}

/// Replaces a share of the pixels by others anywhere in the image.
inline void add_outliers(Correspondences& c, glm::ivec2 size, double share, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  for (auto& pixel : c.projector_pixels) {
    if (uniform(random) < share) pixel = {uniform(random) * size.x, uniform(random) * size.y};
  }
}

/// The tangent error of an estimate: fx, fy, cx, cy, lens, rotation (left, device frame), translation.
inline std::vector<double> tangent_error(const Device& truth, const Device& estimate) {
  const auto &a = truth.intrinsics, &b = estimate.intrinsics;
  std::vector<double> e = {b.fx - a.fx, b.fy - a.fy, b.cx - a.cx, b.cy - a.cy};
  for (std::size_t i = 0; i < truth.lens.parameters.size(); ++i)
    e.push_back(estimate.lens.parameters[i] - truth.lens.parameters[i]);
  const glm::dvec3 w = rotation_vector_rad(truth.device_from_world.rotation *
                                           glm::transpose(estimate.device_from_world.rotation));
  const glm::dvec3 t = estimate.device_from_world.translation - truth.device_from_world.translation;
  for (int i = 0; i < 3; ++i) e.push_back(-w[i]);
  for (int i = 0; i < 3; ++i) e.push_back(t[i]);
  return e;
}

}  // namespace laterna::testing
