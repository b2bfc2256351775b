#include "apps/lab/report/svg_axes.h"

#include "apps/lab/chart/log_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

double SvgAxis::at(double value) const {
  if (log) return LogAxis{low, high, from, to}.at(value);
  return from + (to - from) * (value - low) / (high - low);
}

SvgAxis axis_over(const std::vector<double>& values, double from, double to, bool log) {
  if (log) {
    const LogAxis axis = axis_around(values, from, to);
    return {axis.low, axis.high, from, to, true};
  }
  double low = INFINITY, high = -INFINITY;
  for (const double v : values)
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  if (low > high) return {0, 1, from, to, false};
  const double spare = high > low ? 0.05 * (high - low) : std::max(0.5, 1e-3 * std::abs(high));
  return {low - spare, high + spare, from, to, false};
}

std::vector<SvgTick> ticks_on(const SvgAxis& axis, int most) {
  std::vector<SvgTick> ticks;
  if (axis.log) {
    for (const Tick& t : ticks_of({axis.low, axis.high, axis.from, axis.to}))
      ticks.push_back({t.value, t.text});
    return ticks;
  }
  const double least = (axis.high - axis.low) / most, decade = std::pow(10, std::floor(std::log10(least)));
  double step = 10 * decade;
  for (const double factor : {5, 2, 1})
    if (factor * decade >= least) step = factor * decade;
  for (double k = std::ceil(axis.low / step); k * step <= axis.high; ++k)
    ticks.push_back({k * step, fmt::format("{:.4g}", k == 0 ? 0 : k * step)});
  return ticks;
}

void draw_axes(Svg& svg, const SvgAxis& x, const SvgAxis& y, const std::string& x_label,
               const std::string& y_label, const std::vector<SvgTick>& x_ticks,
               const std::vector<SvgTick>& y_ticks) {
  constexpr double size = 13;
  const Svg::Stroke faint{neutral_grey, 1, "", 0.25};
  const double bottom = std::max(y.from, y.to), top = std::min(y.from, y.to);
  for (const SvgTick& tick : x_ticks) {
    svg.line({{x.at(tick.value), top}, {x.at(tick.value), bottom}}, faint);
    svg.text(x.at(tick.value), bottom + 18, tick.text, size, Svg::Anchor::middle);
  }
  std::size_t widest = 0;
  for (const SvgTick& tick : y_ticks) {
    svg.line({{x.from, y.at(tick.value)}, {x.to, y.at(tick.value)}}, faint);
    svg.text(x.from - 8, y.at(tick.value) + 4.5, tick.text, size, Svg::Anchor::end);
    widest = std::max(widest, tick.text.size());
  }
  svg.line({{x.from, top}, {x.from, bottom}, {x.to, bottom}}, {});
  svg.text((x.from + x.to) / 2, bottom + 40, x_label, size, Svg::Anchor::middle);
  svg.text(x.from - 22 - 7.2 * double(widest), (top + bottom) / 2, y_label, size, Svg::Anchor::middle, true);
}

}  // namespace laterna
