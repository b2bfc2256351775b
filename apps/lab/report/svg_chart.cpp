#include "apps/lab/report/svg_chart.h"

#include "apps/lab/report/svg_axes.h"

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr double width = 760, top = 64, right = 740, letter = 7.2;

using Kind = SvgSeries::Kind;

bool drawable(const SvgChart& chart, const SvgPoint& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && (!chart.log_x || p.x > 0) && (!chart.log_y || p.y > 0);
}

// Rows from the top, or numbers from the bottom.
SvgAxis vertical(const SvgChart& chart, std::vector<double> values, double bottom) {
  if (!chart.rows.empty()) return {-0.5, double(chart.rows.size()) - 0.5, top, bottom, false};
  SvgAxis axis = axis_over(values, bottom, top, chart.log_y);
  const bool above = std::all_of(values.begin(), values.end(), [](double v) { return v >= 0; });
  if (above && !chart.log_y && axis.low < 0) axis.low = 0;
  return axis;
}

std::vector<SvgTick> vertical_ticks(const SvgChart& chart, const SvgAxis& y) {
  if (chart.rows.empty()) return ticks_on(y);
  std::vector<SvgTick> ticks;
  for (std::size_t k = 0; k < chart.rows.size(); ++k) ticks.push_back({double(k), chart.rows[k]});
  return ticks;
}

void draw_series(Svg& svg, const SvgSeries& series, const SvgAxis& x, const SvgAxis& y) {
  std::vector<std::pair<double, double>> line;
  const double wide =
      series.points.size() > 1 ? std::abs(x.at(series.points[1].x) - x.at(series.points[0].x)) : 20;
  for (const SvgPoint& p : series.points) {
    const double px = x.at(p.x), py = y.at(p.y);
    line.emplace_back(px, py);
    if (series.kind == Kind::bars)
      svg.rect(px - wide / 2, py, std::max(1.0, wide - 1), std::max(0.0, y.at(0) - py), series.colour);
    if (series.kind == Kind::points) svg.marker(px, py, series.marker, series.colour, p.hint);
  }
  if (series.kind == Kind::line) svg.line(line, {series.colour, 2});
  if (series.kind == Kind::dashes) svg.line(line, {series.colour, 2, "5 4"});
}

void draw_key(Svg& svg, const SvgChart& chart) {
  double x = 20;
  for (const SvgSeries& s : chart.series) {
    if (s.name.empty()) continue;
    if (s.kind == Kind::points)
      svg.marker(x + 8, 42, s.marker, s.colour, "");
    else if (s.kind == Kind::bars)
      svg.rect(x, 36, 16, 11, s.colour);
    else
      svg.line({{x, 42}, {x + 16, 42}}, {s.colour, 2, s.kind == Kind::dashes ? "5 4" : ""});
    svg.text(x + 22, 46, s.name, 13);
    x += 44 + letter * double(s.name.size());
  }
}

}  // namespace

std::string svg_chart(const SvgChart& given) {
  SvgChart chart = given;
  std::vector<double> xs, ys;
  for (SvgSeries& s : chart.series) {
    std::erase_if(s.points, [&](const SvgPoint& p) { return !drawable(chart, p); });
    for (const SvgPoint& p : s.points) xs.push_back(p.x), ys.push_back(p.y);
    if (s.kind == Kind::bars && !s.points.empty()) {  // whole bars, down to 0
      const double half = s.points.size() > 1 ? (s.points[1].x - s.points[0].x) / 2 : 0.5;
      xs.insert(xs.end(), {s.points.front().x - half, s.points.back().x + half}), ys.push_back(0);
    }
  }
  const double bottom = chart.rows.empty() ? 370 : top + 28 * double(chart.rows.size());
  Svg svg(width, bottom + 56, chart.title);
  svg.text(20, 22, chart.title, 16);
  if (xs.empty()) {
    svg.text(20, 120, "no points", 13);
    return svg.str();
  }
  SvgAxis y = vertical(chart, ys, bottom);
  const std::vector<SvgTick> y_ticks = vertical_ticks(chart, y);
  std::size_t widest = 0;
  for (const SvgTick& tick : y_ticks) widest = std::max(widest, tick.text.size());
  const SvgAxis x = axis_over(xs, 40 + letter * double(widest), right, chart.log_x);
  draw_axes(svg, x, y, chart.x_label, chart.y_label, ticks_on(x), y_ticks);
  draw_key(svg, chart);
  for (const SvgSeries& s : chart.series) draw_series(svg, s, x, y);
  return svg.str();
}

}  // namespace laterna
