#include "calib/splined_lens.h"

#include "sim/error.h"
#include "sim/spline_knots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace laterna {

namespace {

constexpr int cubic = 3;

// u = 2·tan(θ/2) along the way of (x, y), θ = atan|(x, y)|.
glm::dvec2 stereographic(const glm::dvec2& xy) { return 2.0 / (1 + std::sqrt(1 + glm::dot(xy, xy))) * xy; }

std::optional<glm::dvec2> seen_from(const LensProjection& lens, const glm::dvec2& pixel) {
  const auto ray = lens.unproject(pixel);
  if (!ray) return std::nullopt;
  return stereographic(*ray);
}

// The largest |u| over the image's border, in x and in y.
glm::dvec2 reach(const Device& device) {
  constexpr int steps = 16;
  const LensProjection lens(device.intrinsics, device.lens);
  const glm::dvec2 last = glm::dvec2(device.intrinsics.size) - 1.0;
  glm::dvec2 most(0.0);
  for (int i = 0; i <= steps; ++i) {
    const glm::dvec2 at = double(i) / steps * last;
    for (const glm::dvec2& pixel : {glm::dvec2(at.x, 0), {at.x, last.y}, {0, at.y}, {last.x, at.y}})
      if (const auto u = seen_from(lens, pixel)) most = glm::max(most, glm::abs(*u));
  }
  if (!(most.x > 0 && most.y > 0))
    throw InputError(fmt::format("{}: the lens maps no ray to the image's border", device.name));
  return most;
}

}  // namespace

std::string spline_over_image(const Device& device, int across) {
  const glm::dvec2 most = reach(device);
  const double fov_x_deg = std::ceil(4 * std::atan(most.x / 2) * 180 / std::numbers::pi);
  const double half_x = 2 * std::tan(fov_x_deg / 4 * std::numbers::pi / 180);
  const int cells_x = std::max(1, int(std::ceil(across * std::min(1.0, most.x / most.y))));
  const int cells_y = std::max(1, int(std::ceil(most.y / half_x * cells_x)));
  return fmt::format("LENSMODEL_SPLINED_STEREOGRAPHIC_order={}_Nx={}_Ny={}_fov_x_deg={:.0f}", cubic,
                     cells_x + cubic, cells_y + cubic, fov_x_deg);
}

std::vector<double> spline_like(const Device& device, const std::string& splined_model) {
  const Intrinsics& k = device.intrinsics;
  const LensProjection lens(k, device.lens);
  const glm::dvec2 focal(k.fx, k.fy), center(k.cx, k.cy), last = glm::dvec2(k.size) - 1.0;
  std::vector<double> parameters = {k.fx, k.fy, k.cx, k.cy};
  for (const glm::dvec2& knot : spline_knots(splined_model)) {
    const glm::dvec2 pixel = glm::clamp(center + focal * knot, glm::dvec2(0.0), last);
    const glm::dvec2 u = (pixel - center) / focal, departure = u - seen_from(lens, pixel).value_or(u);
    parameters.insert(parameters.end(), {departure.x, departure.y});
  }
  return parameters;
}

IntrinsicsPrior spline_prior(const std::vector<double>& parameters) {
  constexpr double exact_px = 1e-6;
  IntrinsicsPrior prior{parameters, std::vector<double>(parameters.size(), 1 / spline_departure)};
  std::fill_n(prior.inverse_sigma.begin(), 4, 1 / exact_px);
  return prior;
}

}  // namespace laterna
