#include "apps/lab/chart/log_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

double LogAxis::at(double value) const {
  return from + (to - from) * std::log(value / low) / std::log(high / low);
}

LogAxis axis_around(const std::vector<double>& values, double from, double to) {
  double low = INFINITY, high = 0;
  for (const double v : values) {
    if (!std::isfinite(v) || !(v > 0)) continue;
    low = std::min(low, v), high = std::max(high, v);
  }
  if (high == 0) return {1, 10, from, to};
  const double widen = std::sqrt(std::max(1.0, 2 * low / high));
  const double spare = std::pow(high / low * widen * widen, 0.05);
  return {low / widen / spare, high * widen * spare, from, to};
}

std::vector<Tick> ticks_of(const LogAxis& axis) {
  const double decades = std::log10(axis.high / axis.low);
  std::vector<double> factors{1};
  if (decades < 2) factors = {1, 2, 5};
  if (decades < 1.2) factors = {1, 1.5, 2, 3, 5, 7};
  const int every = decades > 16 ? 3 : decades > 8 ? 2 : 1;
  std::vector<Tick> ticks;
  for (int power = every * int(std::floor(std::log10(axis.low) / every)); power <= std::log10(axis.high);
       power += every)
    for (const double factor : factors) {
      const double value = factor * std::pow(10.0, power);
      if (value >= axis.low && value <= axis.high) ticks.push_back({value, fmt::format("{:.3g}", value)});
    }
  return ticks;
}

}  // namespace laterna
