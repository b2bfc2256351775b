// Two axes of a static figure, their ticks and words.
#pragma once

#include "apps/lab/chart/svg.h"

#include <string>
#include <vector>

namespace laterna {

/// From a value to its place on the picture.
struct SvgAxis {
  double low = 0, high = 1;  ///< what it spans, low < high; above 0 where `log`
  double from = 0, to = 1;   ///< where these are drawn
  bool log = false;
  double at(double value) const;
};

/// An axis around all values, with a twentieth of its length to spare at both ends; a logarithmic one as
/// axis_around() (chart/log_axis.h). Not finite values are left out; 0 to 1 where there is none.
SvgAxis axis_over(const std::vector<double>& values, double from, double to, bool log = false);

struct SvgTick {
  double value;
  std::string text;
};

/// At 1, 2 or 5 times a power of ten, at most `most` + 1 of them; logarithmic ones as ticks_of().
std::vector<SvgTick> ticks_on(const SvgAxis& axis, int most = 6);

/// Ticks with faint lines across, the two axes, and a word at each. Ticks in place of the axis's own where
/// given.
void draw_axes(Svg& svg, const SvgAxis& x, const SvgAxis& y, const std::string& x_label,
               const std::string& y_label, const std::vector<SvgTick>& x_ticks,
               const std::vector<SvgTick>& y_ticks);

}  // namespace laterna
