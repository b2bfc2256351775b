// A logarithmic axis: what it spans, where its ticks stand.
#pragma once

#include <string>
#include <vector>

namespace laterna {

struct LogAxis {
  double low = 1, high = 10;      ///< what it spans, 0 < low < high
  double from = 0, to = 1;        ///< where these are drawn
  double at(double value) const;  ///< where a value above 0 is drawn
};

/// An axis around all values that are finite and above 0, with a twentieth of its length to spare at both
/// ends and no shorter than a factor of 2. 1 to 10 where there is none.
LogAxis axis_around(const std::vector<double>& values, double from, double to);

struct Tick {
  double value = 0;
  std::string text;  ///< "0.02", "1e-05"
};

/// Powers of ten; over less than two decades also their double and fivefold; over less than 1.2 decades also
/// 1.5, 3 and 7 times; over more than eight decades every second or third power.
std::vector<Tick> ticks_of(const LogAxis& axis);

}  // namespace laterna
