// A chart of a few curves over logarithmic axes.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace laterna {

struct LineChart {
  struct Series {
    std::string name;
    std::vector<std::pair<double, double>> points{};  ///< x, y; drawn where both are above 0
    double tolerance = 0.01;  ///< by what share of y another machine may find another value
  };
  std::string name;  ///< of its file, without ".svg"; begins with the classic's name
  std::string title, x_title, y_title;
  std::vector<Series> series;
};

/// The chart as SVG: a line through each series, a marker at each point.
std::string line_chart_svg(const LineChart& chart);

}  // namespace laterna
