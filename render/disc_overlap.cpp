#include "render/disc_overlap.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace laterna {

namespace {

constexpr double quarter = std::numbers::pi / 4;

// Area of the unit disc's part with X ≤ x and Y ≤ y. A corner inside the disc adds its rectangle with the
// centre to the parts beyond both lines; one outside leaves whole segments.
double area_up_to(const DiscEdge& x, const DiscEdge& y) {
  if (x.at * x.at + y.at * y.at < 1) return x.at * y.at + x.half_area + y.half_area + quarter;
  if (x.at <= 0 && y.at <= 0) return 0;
  if (x.at <= 0) return 2 * (x.half_area + quarter);
  if (y.at <= 0) return 2 * (y.half_area + quarter);
  return 2 * (x.half_area + y.half_area);
}

}  // namespace

DiscEdge disc_edge(double at_radii) {
  const double x = std::clamp(at_radii, -1.0, 1.0);
  return {x, (x * std::sqrt(1 - x * x) + std::asin(x)) / 2};
}

double disc_share(const DiscEdge& left, const DiscEdge& right, const DiscEdge& top, const DiscEdge& bottom) {
  const double area =
      area_up_to(right, bottom) - area_up_to(left, bottom) - area_up_to(right, top) + area_up_to(left, top);
  return std::max(0.0, area / std::numbers::pi);
}

}  // namespace laterna
