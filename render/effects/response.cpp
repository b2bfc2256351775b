#include "render/effects/response.h"

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

double table_value(const std::vector<double>& table, double p) {
  const double at = p * double(table.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), table.size() - 2);
  return table[i] + (at - double(i)) * (table[i + 1] - table[i]);
}

}  // namespace

void apply_response(PatternStack& patterns, const ProjectorEffects& effects) {
  for (float& light : patterns.light_of_value) {
    if (effects.response_exponent) light = float(std::pow(double(light), *effects.response_exponent));
    if (!effects.response_table.empty()) light = float(table_value(effects.response_table, light));
  }
}

void apply_black_level(PatternStack& patterns, const ProjectorEffects& effects) {
  if (!effects.black_level) return;
  const double black = *effects.black_level;
  for (float& light : patterns.light_of_value) light = float(black + (1 - black) * double(light));
}

double black_light(const Effects& on, const ProjectorEffects& effects) {
  const bool has_table = on.response && !effects.response_table.empty();
  const double response = has_table ? effects.response_table[0] : 0;
  const double black = on.black_level ? effects.black_level.value_or(0) : 0;
  return black + (1 - black) * response;
}

}  // namespace laterna
