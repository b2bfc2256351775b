#include "apps/lab/report/svg_chart.h"

#include "apps/lab/report/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr double left = 80, right = 700, top = 50, bottom = 340;

struct Axis {
  double low = 0, high = 1, from = 0, to = 1;
  bool log = false;

  double scaled(double v) const { return log ? std::log10(v) : v; }
  double place(double v) const { return from + (scaled(v) - low) / (high - low) * (to - from); }
};

bool drawable(const Chart& chart, const ChartPoint& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && (!chart.log_x || p.x > 0) && (!chart.log_y || p.y > 0);
}

// The axis around all values, with a little air.
Axis axis_of(std::vector<double> values, bool log, double from, double to) {
  Axis axis{0, 1, from, to, log};
  for (double& v : values) v = axis.scaled(v);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double air = *high > *low ? 0.05 * (*high - *low) : 0.5;
  axis.low = *low - air, axis.high = *high + air;
  return axis;
}

std::vector<double> ticks(const Axis& axis) {
  const double step0 = (axis.high - axis.low) / 6;
  const double decade = std::pow(10, std::floor(std::log10(step0)));
  double step = axis.log ? std::max(1.0, std::ceil(step0)) : decade;
  if (!axis.log) step *= step0 / decade > 5 ? 10 : step0 / decade > 2 ? 5 : step0 / decade > 1 ? 2 : 1;
  std::vector<double> values;
  for (double v = std::ceil(axis.low / step) * step; v <= axis.high; v += step)
    values.push_back(axis.log ? std::pow(10, v) : std::abs(v) < step / 1e6 ? 0 : v);
  return values;
}

std::string axes_svg(const Chart& chart, const Axis& x, const Axis& y) {
  std::string svg =
      fmt::format("<path d=\"M{0} {1}V{2}H{3}\" fill=\"none\" stroke=\"#333\"/>\n", left, top, bottom, right);
  for (const double v : ticks(x))
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{:.4g}</text>\n", x.place(v),
                       bottom + 18, v);
  for (const double v : ticks(y))
    svg += fmt::format(
        "<path d=\"M{0} {1:.1f}H{2}\" stroke=\"#ddd\"/><text x=\"{3}\" y=\"{4:.1f}\" "
        "text-anchor=\"end\">{5:.4g}</text>\n",
        left, y.place(v), right, left - 8, y.place(v) + 4, v);
  return svg + fmt::format(
                   "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n<text x=\"14\" y=\"{}\" "
                   "transform=\"rotate(-90 14 {})\" text-anchor=\"middle\">{}</text>\n",
                   (left + right) / 2, bottom + 42, html_text(chart.x_label), (top + bottom) / 2,
                   (top + bottom) / 2, html_text(chart.y_label));
}

std::string series_svg(const ChartSeries& series, const Axis& x, const Axis& y) {
  std::string svg, path;
  const double width =
      series.points.size() > 1 ? std::abs(x.place(series.points[1].x) - x.place(series.points[0].x)) : 20;
  for (const ChartPoint& p : series.points) {
    const double px = x.place(p.x), py = y.place(p.y);
    if (series.kind == ChartSeries::Kind::line)
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px, py);
    if (series.kind == ChartSeries::Kind::bars)
      svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
                         px - width / 2, py, std::max(1.0, width - 1), std::max(0.0, y.place(0) - py),
                         series.colour);
    if (series.kind == ChartSeries::Kind::points)
      svg +=
          fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n", px, py, series.colour);
    if (!p.label.empty())
      svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"11\">{}</text>\n", px + 7, py - 5,
                         html_text(p.label));
  }
  if (!path.empty())
    svg +=
        fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n", path, series.colour);
  return svg;
}

std::string key_svg(const Chart& chart) {
  std::string svg;
  double x = left;
  for (const ChartSeries& s : chart.series) {
    svg += fmt::format(
        "<rect x=\"{:.0f}\" y=\"32\" width=\"10\" height=\"10\" fill=\"{}\"/><text x=\"{:.0f}\" "
        "y=\"41\">{}</text>\n",
        x, s.colour, x + 15, html_text(s.name));
    x += 35 + 7.0 * double(s.name.size());
  }
  return svg;
}

}  // namespace

std::string svg_chart(const Chart& given) {
  Chart chart = given;
  std::vector<double> xs, ys;
  for (ChartSeries& s : chart.series) {
    std::erase_if(s.points, [&](const ChartPoint& p) { return !drawable(chart, p); });
    for (const ChartPoint& p : s.points) xs.push_back(p.x), ys.push_back(p.y);
    if (s.kind == ChartSeries::Kind::bars) ys.push_back(0);
  }
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 720 400\" role=\"img\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<title>{0}</title>\n<rect width=\"720\" height=\"400\" "
      "fill=\"#fff\"/>\n<text x=\"{1}\" y=\"20\" font-size=\"15\">{0}</text>\n",
      html_text(chart.title), left);
  if (xs.empty()) return svg + fmt::format("<text x=\"{}\" y=\"200\">no points</text>\n</svg>\n", left);
  const Axis x = axis_of(xs, chart.log_x, left, right), y = axis_of(ys, chart.log_y, bottom, top);
  svg += axes_svg(chart, x, y) + key_svg(chart);
  for (const ChartSeries& s : chart.series) svg += series_svg(s, x, y);
  return svg + "</svg>\n";
}

}  // namespace laterna
