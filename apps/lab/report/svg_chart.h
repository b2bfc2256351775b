// A plain chart as SVG: points, lines and bars over two axes, or over named rows.
#pragma once

#include <string>
#include <vector>

namespace laterna {

struct SvgPoint {
  double x = 0, y = 0;
  std::string hint{};  ///< shown when a pointer rests on it
};

struct SvgSeries {
  enum class Kind { points, line, dashes, bars } kind = Kind::points;
  std::string name;    ///< in the key
  std::string colour;  ///< "#0072B2"
  std::vector<SvgPoint> points;
  int marker = 0;  ///< shape (chart/svg.h)
};

struct SvgChart {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<SvgSeries> series;
  std::vector<std::string> rows{};  ///< names of y = 0, 1, ..., from the top; none: y is a number
};

/// 760 units wide; words in a grey that reads on white and on black; a title element for screen readers.
/// Points that are not finite, or not positive on a logarithmic axis, are left out; a chart without points
/// says so. Bars stand on y = 0, as wide as the distance of the first two.
std::string svg_chart(const SvgChart& chart);

}  // namespace laterna
