#include "apps/lab/classics/line_chart.h"

#include "apps/lab/chart/log_axis.h"
#include "apps/lab/chart/svg.h"

#include <fmt/format.h>

#include <array>

namespace laterna {

namespace {

constexpr double width = 760, height = 420;
constexpr double left = 80, right = 480, top = 50, bottom = 350;  // of the axes
constexpr double text_px = 13;
const std::array<const char*, 6> colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"};

bool drawn(const std::pair<double, double>& p) { return p.first > 0 && p.second > 0; }

struct Axes {
  LogAxis x, y;
};

Axes axes_around(const LineChart& chart) {
  std::vector<double> xs, ys;
  for (const auto& series : chart.series)
    for (const auto& p : series.points) {
      if (!drawn(p)) continue;
      xs.push_back(p.first);
      ys.push_back(p.second);
    }
  return {axis_around(xs, left, right), axis_around(ys, bottom, top)};
}

void draw_axes(const LineChart& chart, const Axes& axes, Svg& svg) {
  const Svg::Stroke faint{neutral_grey, 1, "", 0.25};
  for (const Tick& tick : ticks_of(axes.x)) {
    const double x = axes.x.at(tick.value);
    svg.line({{x, top}, {x, bottom}}, faint);
    svg.text(x, bottom + 18, tick.text, text_px, Svg::Anchor::middle);
  }
  for (const Tick& tick : ticks_of(axes.y)) {
    const double y = axes.y.at(tick.value);
    svg.line({{left, y}, {right, y}}, faint);
    svg.text(left - 8, y + 4.5, tick.text, text_px, Svg::Anchor::end);
  }
  svg.line({{left, top}, {left, bottom}, {right, bottom}}, {});
  svg.text((left + right) / 2, bottom + 44, chart.x_title, text_px + 1, Svg::Anchor::middle);
  svg.text(22, (top + bottom) / 2, chart.y_title, text_px + 1, Svg::Anchor::middle, true);
  svg.text(left, 28, chart.title, 16);
}

void draw_series(const LineChart& chart, const Axes& axes, Svg& svg) {
  double legend_y = top + 10;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const auto& series = chart.series[i];
    const std::string colour = colours[i % colours.size()];
    const int shape = int(i) % marker_shapes;
    std::vector<std::pair<double, double>> line;
    for (const auto& p : series.points)
      if (drawn(p)) line.emplace_back(axes.x.at(p.first), axes.y.at(p.second));
    svg.line(line, {colour, 1.5, "", 0.7});
    for (const auto& p : series.points)
      if (drawn(p))
        svg.marker(axes.x.at(p.first), axes.y.at(p.second), shape, colour,
                   fmt::format("{}: {:.4g}, {:.4g}", series.name, p.first, p.second));
    svg.marker(right + 24, legend_y - 4, shape, colour, "");
    svg.text(right + 38, legend_y, series.name, text_px);
    legend_y += 22;
  }
}

}  // namespace

std::string line_chart_svg(const LineChart& chart) {
  const Axes axes = axes_around(chart);
  Svg svg(width, height, chart.title);
  draw_axes(chart, axes, svg);
  draw_series(chart, axes, svg);
  return svg.str();
}

}  // namespace laterna
