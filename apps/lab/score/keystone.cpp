#include "apps/lab/score/keystone.h"

#include "calib/correspondences.h"
#include "calib/projection_rows.h"
#include "render/effects/scaler.h"
#include "sim/rq.h"
#include "sim/texture_matrix.h"

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace laterna {

namespace {

constexpr std::size_t most_points = 300, fewest_points = 50, most_lens_parameters = 14;
constexpr std::array<const char*, 4> edges{"upper", "right", "lower", "left"};

// Shares of an edge, from its first end clockwise and from its second.
struct Shares {
  double a = 0.05, b = 0.05;
};

glm::dmat3 input_from_panel_of(int edge, const Shares& s, glm::ivec2 size) {
  Scaler scaler;
  scaler.keystone = {0, 0, 1, 0, 1, 1, 0, 1};
  static constexpr std::array<glm::dvec2, 4> along{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  const int first = edge, second = (edge + 1) % 4;
  for (int axis = 0; axis < 2; ++axis) {
    scaler.keystone[2 * first + axis] += s.a * along[edge][axis];
    scaler.keystone[2 * second + axis] -= s.b * along[edge][axis];
  }
  return input_from_panel(scaler, size, size);
}

glm::dvec2 mapped(const glm::dmat3& h, const glm::dvec2& pixel) {
  const glm::dvec3 q = h * glm::dvec3(pixel, 1.0);
  return glm::dvec2(q) / q.z;
}

// The points that a result is looked at on: of the surface, with the pixels that it gives them.
struct Looked {
  Device device;  ///< the result, aligned
  std::vector<glm::dvec3> points_world;
  std::vector<glm::dvec2> true_pixels, pixels;
};

std::optional<Looked> looked_at(const ScoreRig& result, const Probe& probe) {
  const auto device = align(result, probe.truth, probe.alignment);
  if (!device || device->intrinsics.size != probe.truth.projector.intrinsics.size ||
      device->lens.parameters.size() > most_lens_parameters ||
      glm::determinant(device->device_from_world.rotation) < 0)
    return std::nullopt;
  Looked looked{*device, {}, {}, {}};
  const std::vector<glm::dvec2> pixels = quick_pixels(*device, probe.points_world);
  const std::size_t count = probe.points_world.size() - probe.surface_begin;
  for (const std::size_t i : evenly_spread(count, most_points)) {
    const glm::dvec2 pixel = pixels[probe.surface_begin + i];
    if (!std::isfinite(pixel.x + pixel.y)) continue;
    looked.points_world.push_back(probe.points_world[probe.surface_begin + i]);
    looked.true_pixels.push_back(probe.true_pixels[probe.surface_begin + i]);
    looked.pixels.push_back(pixel);
  }
  if (looked.points_world.size() < fewest_points) return std::nullopt;
  return looked;
}

// An orthonormal basis of what the result's parameters can move its pixels by: 2n × p.
cv::Mat basis_of(const Looked& looked) {
  const LensGradient lens(looked.device.lens.model);
  const int p = lens.parameter_count() + 6;
  const WorldNormalisation normalisation = normalisation_of(looked.points_world);
  ProjectorState state = state_of(looked.device);
  state.device_from_points = device_from_normalised(state.device_from_points, normalisation);
  cv::Mat jacobian = cv::Mat::zeros(2 * int(looked.points_world.size()), p, CV_64F);
  double pixel[2];
  for (std::size_t i = 0; i < looked.points_world.size(); ++i) {
    const glm::dvec3 x = (looked.points_world[i] - normalisation.center) / normalisation.scale_m;
    if (!project_with_rows(lens, state, x, pixel, jacobian.ptr<double>(2 * int(i)))) return {};
  }
  for (int c = 0; c < p; ++c) jacobian.col(c) /= std::max(cv::norm(jacobian.col(c)), 1e-300);
  return cv::SVD(jacobian).u;
}

using Misfit = std::function<cv::Mat(const Shares&)>;  ///< a column, in pixels

struct Fit {
  Shares shares;
  double misfit_px2 = 0;  ///< |misfit|²
};

// Gauss-Newton over the two shares, which stay between a bit below 0 and 0.45; a step that does not help is
// halved.
Fit fitted_from(const Shares& start, const Misfit& misfit) {
  const auto within = [](double share) { return std::clamp(share, -0.01, 0.45); };
  Fit best{start, cv::norm(misfit(start), cv::NORM_L2SQR)};
  bool helps = true;
  for (int iteration = 0; iteration < 12 && helps; ++iteration) {
    constexpr double step = 1e-5;
    const auto [a, b] = best.shares;
    const cv::Mat at = misfit(best.shares);
    cv::Mat jacobian, move;
    cv::hconcat((misfit({a + step, b}) - at) / step, (misfit({a, b + step}) - at) / step, jacobian);
    if (!cv::solve(jacobian, -at, move, cv::DECOMP_SVD)) break;
    helps = false;
    for (int halvings = 0; halvings < 4 && !helps; ++halvings, move /= 2) {
      const Shares next{within(a + move.at<double>(0)), within(b + move.at<double>(1))};
      const double misfit_px2 = cv::norm(misfit(next), cv::NORM_L2SQR);
      helps = misfit_px2 < best.misfit_px2 * (1 - 1e-6);
      if (helps) best = {next, misfit_px2};
    }
  }
  return best;
}

Fit fitted(const Misfit& misfit) {
  Fit best = fitted_from({0.05, 0.05}, misfit);
  for (const Shares& start : {Shares{0.02, 0.2}, Shares{0.2, 0.02}}) {
    const Fit fit = fitted_from(start, misfit);
    if (fit.misfit_px2 < best.misfit_px2) best = fit;
  }
  return best;
}

bool is_keystone(const Shares& s) { return s.a > -0.003 && s.b > -0.003 && s.a + s.b > 0.005; }

cv::Mat column(const std::vector<glm::dvec2>& pixels) {
  cv::Mat m(2 * int(pixels.size()), 1, CV_64F);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    m.at<double>(2 * int(i)) = pixels[i].x, m.at<double>(2 * int(i) + 1) = pixels[i].y;
  return m;
}

// h·K·R of the true projector as K and R again, without the skew; its centre and lens stay.
Device without_skew(Device d, const glm::dmat3& h) {
  const glm::ivec2 size = d.intrinsics.size;
  const glm::dmat4x3 pixel_from_world =
      pixel_from_object(texture_from_object(d.intrinsics, {}, d.device_from_world), size);
  const KAndR parts = k_and_r(h * glm::dmat3(pixel_from_world), size);
  const glm::dvec3 centre_world = center_in_world(d.device_from_world);
  d.intrinsics = parts.intrinsics;
  d.device_from_world = {parts.rotation, -(parts.rotation * centre_world)};
  return d;
}

std::vector<glm::dvec2> pixels_of(const Device& device, const std::vector<glm::dvec3>& points_world) {
  std::vector<glm::dvec2> pixels = quick_pixels(device, points_world);
  for (glm::dvec2& pixel : pixels)
    if (!std::isfinite(pixel.x + pixel.y)) pixel = glm::dvec2(1e6);
  return pixels;
}

}  // namespace

std::optional<Keystone> keystone_of(const ScoreRig& result, const Probe& probe) {
  const auto looked = looked_at(result, probe);
  if (!looked) return std::nullopt;
  const glm::ivec2 size = probe.truth.projector.intrinsics.size;
  const double error_px2 = squared_error_px2(result_pixels(result, probe), probe);
  std::optional<Keystone> best;
  const auto keep = [&](int edge, const Fit& fit, double remaining_px2) {
    if (!is_keystone(fit.shares) || (best && best->remaining_px2 <= remaining_px2)) return;
    best = {remaining_px2,
            fmt::format("the picture's {} edge is drawn in by {:.1f} % and {:.1f} %", edges[edge],
                        100 * std::max(0.0, fit.shares.a), 100 * std::max(0.0, fit.shares.b))};
  };
  const cv::Mat found = column(looked->pixels), basis = basis_of(*looked);
  const double n = double(looked->points_world.size());
  for (int edge = 0; edge < 4; ++edge) {
    if (!basis.empty()) {
      const cv::Mat from = basis.t() * (column(looked->true_pixels) - found);
      const Fit fit = fitted([&](const Shares& s) -> cv::Mat {
        std::vector<glm::dvec2> moved = looked->true_pixels;
        const glm::dmat3 h = input_from_panel_of(edge, s, size);
        for (glm::dvec2& pixel : moved) pixel = mapped(h, pixel);
        return basis.t() * (column(moved) - found);
      });
      keep(edge, fit, error_px2 * fit.misfit_px2 / std::max(cv::norm(from, cv::NORM_L2SQR), 1e-300));
    }
    for (const bool is_confused : {false, true}) {
      const Fit fit = fitted([&](const Shares& s) -> cv::Mat {
        const glm::dmat3 h = input_from_panel_of(edge, s, size);
        return column(pixels_of(without_skew(probe.truth.projector, is_confused ? glm::inverse(h) : h),
                                looked->points_world)) -
               found;
      });
      keep(edge, fit, fit.misfit_px2 / n);
    }
  }
  return best;
}

}  // namespace laterna
