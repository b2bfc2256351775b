#include "sim/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace laterna {

bool in_range(const Field& field, double number) {
  const bool above = field.low_excluded ? number > field.low : number >= field.low;
  return std::isfinite(number) && above && number <= field.high;
}

std::string range_text(const Field& field) {
  const bool has_low = std::isfinite(field.low), has_high = std::isfinite(field.high);
  if (has_low && has_high && field.low_excluded)
    return fmt::format("above {:.6g} and at most {:.6g}", field.low, field.high);
  if (has_low && has_high) return fmt::format("{:.6g} to {:.6g}", field.low, field.high);
  if (has_low) return fmt::format("{} {:.6g}", field.low_excluded ? "above" : "at least", field.low);
  if (has_high) return fmt::format("at most {:.6g}", field.high);
  return {};
}

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);  // distances from the part of `a` so far to each beginning of `b`
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    int diagonal = row[0];
    row[0] = int(i) + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const int replaced = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string nearest_key(std::string_view key, std::span<const std::string> known) {
  key = key.substr(0, 64);  // an absurdly long key is near to nothing anyway
  const auto begins_so = [&](const std::string& name) { return key.size() > 2 && name.starts_with(key); };
  if (const auto whole = std::find_if(known.begin(), known.end(), begins_so); whole != known.end())
    return *whole;
  const auto nearer = [&](const std::string& a, const std::string& b) {
    return edit_distance(key, a) < edit_distance(key, b);
  };
  const auto nearest = std::min_element(known.begin(), known.end(), nearer);
  return nearest == known.end() ? std::string() : *nearest;
}

}  // namespace laterna
