#include "calib/geometry_check.h"

#include "calib/projection_rows.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace laterna {

namespace {

constexpr double flat = 1e-9;

struct Spread {
  Eigen::VectorXd standard_deviation;  // largest first
  Eigen::MatrixXd axes;                // columns
};

// Principal axes by SVD of the triangular factor of the centred coordinates: a covariance matrix would lose
// half of the digits.
template <int D, class Point>
Spread spread_of(const LargeVector<Point>& points) {
  const Point origin = points.front();
  Point mean(0.0);
  for (const auto& x : points) mean += (x - origin) / double(points.size());
  StackedRows rows;
  rows.items = points.size();
  rows.rows_per_item = 1;
  rows.columns = D;
  rows.fill = [&](std::size_t begin, std::size_t end, const RowBlock& block) {
    for (std::size_t i = begin; i < end; ++i)
      for (int j = 0; j < D; ++j) block.column(j)[i - begin] = (points[i] - origin - mean)[j];
    return true;
  };
  const auto r = triangular_factor(rows).value_or(std::vector<double>(D * D));  // never fails
  const Eigen::MatrixXd factor =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(r.data(), D,
                                                                                               D);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(factor, Eigen::ComputeFullV);
  return {svd.singularValues() / std::sqrt(double(points.size())), svd.matrixV()};
}

// How many different points there are, counted up to `enough`.
std::size_t distinct(std::span<const glm::dvec3> points, std::size_t enough) {
  std::vector<glm::dvec3> seen;
  for (std::size_t i = 0; i < points.size() && seen.size() < enough; ++i) {
    if (std::find(seen.begin(), seen.end(), points[i]) == seen.end()) seen.push_back(points[i]);
  }
  return seen.size();
}

double largest_coordinate(std::span<const glm::dvec3> points) {
  double largest = 0;
  for (const auto& x : points) largest = std::max({largest, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
  return largest;
}

std::string fraction(double small, double large) { return fmt::format("{:.1g} of the first", small / large); }

}  // namespace

GeometryReport check_geometry(const Correspondences& c, int parameter_count) {
  GeometryReport report;
  const auto say = [&](Geometry verdict, std::string reason) {
    report.verdict = verdict, report.reason = std::move(reason);
    return report;
  };
  const bool placement = parameter_count == 6;
  const std::size_t n = c.world_points.size(),
                    needed = placement ? 4 : std::max(6, (parameter_count + 1) / 2);
  if (n < needed) {
    return say(Geometry::too_few, fmt::format("{} correspondences, a projector with {} parameters needs at "
                                              "least {}",
                                              n, parameter_count, needed));
  }
  const Spread world = spread_of<3>(c.world_points);
  const Spread pixels = spread_of<2>(c.projector_pixels);
  const Eigen::VectorXd& s = world.standard_deviation;
  report.spread_m = {s[0], s[1], s[2]};
  report.thin_axis_world = {world.axes(0, 2), world.axes(1, 2), world.axes(2, 2)};
  const double rounding = 8 * std::numeric_limits<double>::epsilon() * largest_coordinate(c.world_points);
  const double threshold = std::max(flat * s[0], rounding);
  if (s[0] <= rounding || s[0] == 0) return say(Geometry::identical, "all world points are the same point");
  if (s[1] <= threshold) {
    return say(Geometry::collinear,
               "all world points lie on one line: their second spread is " + fraction(s[1], s[0]));
  }
  const std::size_t places = distinct(c.world_points, needed);
  if (places < needed) {
    return say(Geometry::too_few, fmt::format("{} correspondences at {} different world points, a projector "
                                              "with {} parameters needs at least {}",
                                              n, places, parameter_count, needed));
  }
  if (pixels.standard_deviation[1] <= flat * pixels.standard_deviation[0] ||
      pixels.standard_deviation[0] == 0) {
    return say(Geometry::pixels_collinear, "all projector pixels lie on one line or are the same pixel");
  }
  if (s[2] <= threshold && !placement) {
    return say(Geometry::coplanar,
               "all world points lie in one plane (their third spread is " + fraction(s[2], s[0]) +
                   "): focal length and distance cannot be told apart, a placement with known "
                   "intrinsics can");
  }
  return report;
}

double relief_over_throw(const Correspondences& c, const GeometryReport& report,
                         const Rigid& device_from_world) {
  const WorldNormalisation n = normalisation_of(c.world_points);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& x : c.world_points) {
    const double along = glm::dot(x - n.center, report.thin_axis_world);
    low = std::min(low, along), high = std::max(high, along);
  }
  return (high - low) / glm::length(apply(device_from_world, n.center));
}

}  // namespace laterna
