// A plain chart as SVG: points, lines and steps over two axes.
#pragma once

#include <string>
#include <vector>

namespace laterna {

struct ChartPoint {
  double x = 0, y = 0;
  std::string label{};  ///< written beside the point; empty: none
};

struct ChartSeries {
  enum class Kind { points, line, bars } kind = Kind::points;
  std::string name;    ///< in the key
  std::string colour;  ///< "#0072B2"
  std::vector<ChartPoint> points;
};

struct Chart {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<ChartSeries> series;
};

/// 720×400 units, black on white, a title element for screen readers. Points that are not finite, or not
/// positive on a logarithmic axis, are left out; a chart without points says so. Bars stand on y = 0, as wide
/// as the distance of the first two.
std::string svg_chart(const Chart& chart);

}  // namespace laterna
