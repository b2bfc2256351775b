#include "sim/formats/fisheye.h"

#include "sim/error.h"
#include "sim/spline_knots.h"

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace laterna {

namespace {

constexpr double degree = std::numbers::pi / 180, widest = 85 * degree;
constexpr double good_px = 0.002, worst_px = 0.02, largest_coefficient = 1e4;
constexpr int knots_tried[] = {12, 16, 24, 32, 48, 64, 96};
constexpr int tested_across = 65;

// θ_d of an angle, and back.
class Equidistant {
 public:
  explicit Equidistant(std::span<const double> k) : k_(k) {
    constexpr double step = 0.1 * degree;
    while (last_ + step <= widest && distorted(last_ + step) > distorted(last_)) last_ += step;
  }

  double distorted(double theta) const {
    const double t2 = theta * theta;
    return theta * (1 + t2 * (k_[0] + t2 * (k_[1] + t2 * (k_[2] + t2 * k_[3]))));
  }

  // None beyond 85° and where θ_d no longer rises.
  std::optional<double> angle(double theta_d) const {
    if (!(theta_d <= distorted(last_))) return std::nullopt;
    double low = 0, high = last_;
    for (int i = 0; i < 45; ++i) {
      const double middle = 0.5 * (low + high);
      (distorted(middle) < theta_d ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

 private:
  std::span<const double> k_;
  double last_ = 0;  // θ_d rises up to this angle
};

// A pixel, and the angle from the axis and the ray (x/z, y/z, 1) that the file's model gives it.
struct Sight {
  glm::dvec2 pixel;
  double theta;
  glm::dvec3 ray;
};

std::vector<Sight> sights_over(const Intrinsics& k, const Equidistant& model, const std::string& place) {
  std::vector<Sight> sights;
  sights.reserve(std::size_t(tested_across) * tested_across);
  for (int i = 0; i < tested_across * tested_across; ++i) {
    const glm::dvec2 part(i % tested_across, i / tested_across);
    const glm::dvec2 pixel = glm::dvec2(k.size) * part / double(tested_across - 1) - 0.5;
    const glm::dvec2 along((pixel.x - k.cx) / k.fx, (pixel.y - k.cy) / k.fy);
    const double theta_d = glm::length(along);
    const auto theta = model.angle(theta_d);
    if (!theta)
      throw InputError(
          fmt::format("{}: pixel ({}, {}) of the fisheye lens has no ray within 85° of the "
                      "axis, expected each to have one",
                      place, pixel.x, pixel.y));
    const glm::dvec2 unit = theta_d > 0 ? along / theta_d : glm::dvec2(0.0);
    sights.push_back({pixel, *theta, {std::tan(*theta) * unit, 1.0}});
  }
  return sights;
}

double b_spline(double t) {
  t = std::abs(t);
  return t >= 2 ? 0 : t >= 1 ? std::pow(2 - t, 3) / 6 : 2.0 / 3 - t * t + t * t * t / 2;
}

// Where the spline, whose knot i stands at i, is told its value: at the knots between its ends, and halfway
// to the next one of either end.
std::vector<double> told_places(int knots) {
  std::vector<double> places{1, 1.5};
  for (int i = 2; i < knots - 2; ++i) places.push_back(i);
  places.insert(places.end(), {knots - 2.5, knots - 2.0});
  return places;
}

// The x of Δu.
double shift_x(const Equidistant& model, const glm::dvec2& u) {
  const double length = glm::length(u);
  return length > 0 ? (model.distorted(2 * std::atan(length / 2)) / length - 1) * u.x : 0;
}

// B·X·Bᵀ = F: knots X of a tensor product whose values at the told places are F.
cv::Mat knots_through(const cv::Mat& values, const std::vector<double>& places) {
  const int n = values.rows;
  cv::Mat basis(n, n, CV_64F), half, whole;
  for (int p = 0; p < n; ++p)
    for (int knot = 0; knot < n; ++knot) basis.at<double>(p, knot) = b_spline(places[std::size_t(p)] - knot);
  cv::solve(basis, values, half, cv::DECOMP_LU);
  cv::solve(basis, half.t(), whole, cv::DECOMP_LU);
  return whole.t();
}

// The grid is the same in x and y, so the y of Δu is its x with rows and columns exchanged.
Lens splined(const Equidistant& model, int fov_deg, int knots) {
  Lens lens{
      fmt::format("LENSMODEL_SPLINED_STEREOGRAPHIC_order=3_Nx={0}_Ny={0}_fov_x_deg={1}", knots, fov_deg), {}};
  const std::vector<glm::dvec2> grid = spline_knots(lens.model);
  const double first = grid[0].x, spacing = grid[1].x - first;
  const std::vector<double> places = told_places(knots);
  cv::Mat values(knots, knots, CV_64F);
  for (int row = 0; row < knots; ++row)
    for (int column = 0; column < knots; ++column)
      values.at<double>(row, column) =
          shift_x(model, first + spacing * glm::dvec2(places[std::size_t(column)], places[std::size_t(row)]));
  const cv::Mat x = knots_through(values, places);
  for (int row = 0; row < knots; ++row)
    for (int column = 0; column < knots; ++column)
      lens.parameters.insert(lens.parameters.end(), {x.at<double>(row, column), x.at<double>(column, row)});
  return lens;
}

// The first that is above `most_px`, where there is one; infinite where a ray has no pixel.
double largest_difference_px(const Intrinsics& k, const Lens& lens, const std::vector<Sight>& sights,
                             double most_px) {
  const LensGradient projection(lens.model);
  std::vector<double> parameters{k.fx, k.fy, k.cx, k.cy};
  parameters.insert(parameters.end(), lens.parameters.begin(), lens.parameters.end());
  double largest = 0;
  for (std::size_t i = 0; i < sights.size() && largest <= most_px; ++i) {
    double pixel[2];
    if (!projection.project(parameters, sights[i].ray, pixel, nullptr, nullptr))
      return std::numeric_limits<double>::infinity();
    largest = std::max(largest, glm::distance(glm::dvec2(pixel[0], pixel[1]), sights[i].pixel));
  }
  return largest;
}

}  // namespace

Lens lens_from_fisheye(const Device& device, std::span<const double> k, const std::string& place,
                       Notes& notes) {
  validate(device.intrinsics, place.c_str());
  if (k.size() != 4)
    throw InputError(fmt::format("{}: found {} coefficients of a fisheye lens, expected 4", place, k.size()));
  for (const double number : k)
    if (!(std::abs(number) <= largest_coefficient))
      throw InputError(fmt::format("{}: found {} as a coefficient of a fisheye lens, expected within ±{:.0e}",
                                   place, number, largest_coefficient));
  const Equidistant model(k);
  const std::vector<Sight> sights = sights_over(device.intrinsics, model, place);
  const double farthest = std::ranges::max(sights, {}, &Sight::theta).theta;
  const int fov_deg = int(std::ceil(2 * farthest / degree)) + 1;
  for (const int knots : knots_tried) {
    Lens lens = splined(model, fov_deg, knots);
    const double allowed_px = knots < std::end(knots_tried)[-1] ? good_px : worst_px;
    const double largest = largest_difference_px(device.intrinsics, lens, sights, allowed_px);
    if (!(largest <= allowed_px) ||
        !(LensProjection(device.intrinsics, lens).fold_radius() > std::tan(farthest)))
      continue;
    notes.push_back(
        fmt::format("lens of \"{0}\": fisheye fitted by a spline of {1}×{1} knots within {2:.2g} px",
                    device.name, knots, largest));
    return lens;
  }
  throw InputError(
      fmt::format("{}: no spline of up to {}×{} knots comes within {} px of the fisheye lens, expected one",
                  place, std::end(knots_tried)[-1], std::end(knots_tried)[-1], worst_px));
}

}  // namespace laterna
