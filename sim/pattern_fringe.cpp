// The periods of phase families, and whether they tell every place from every other.
#include "sim/pattern_sequence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace laterna {

namespace {

/// Found by random search: at pitches of 16 to 48 px, on 1080 to 1920 px, the least fringe distance is 0.37.
constexpr double micro_factors[] = {1, 0.888, 0.895, 0.913, 0.937, 1.101};

constexpr double two_pi = 2 * std::numbers::pi;

/// Widening at most 8-fold, a coarser fringe's phase still tells the finer one's period at 1/16 of its own.
std::vector<double> geometric_pitches(double finest, double span) {
  const int more = std::max(1, int(std::ceil(std::log(span / finest) / std::log(8.0))));
  std::vector<double> pitches;
  for (int i = 0; i <= more; ++i) pitches.push_back(finest * std::pow(span / finest, double(i) / more));
  return pitches;
}

/// Σ (cos φ(x) - cos φ(x'))² over the pictures of one fringe: N·(1 - cos Δ) for N equal steps.
double squared_distance(double pitch, int steps, double x, double x_other) {
  if (steps >= 3) return steps * (1 - std::cos(two_pi * (x - x_other) / pitch));
  const double difference = std::cos(two_pi * x / pitch) - std::cos(two_pi * x_other / pitch);
  return difference * difference;
}

}  // namespace

std::vector<double> fringe_pitches_px(const PatternParameters& p, int size_px) {
  const double pitch = p.pitch_px, span = std::max(size_px + pitch, 2 * pitch);
  if (p.kind == PatternKind::gray_phase) return {pitch};
  if (p.kind == PatternKind::phase) return {pitch, span};
  if (!p.pitches_px.empty()) {
    std::vector<double> pitches = p.pitches_px;
    if (p.kind == PatternKind::multi_frequency) std::sort(pitches.begin(), pitches.end());
    return pitches;
  }
  if (p.kind == PatternKind::multi_frequency) return geometric_pitches(pitch, span);
  std::vector<double> pitches;
  for (const double factor : micro_factors) pitches.push_back(factor * pitch);
  return pitches;
}

double least_fringe_distance(const PatternParameters& p, int size_px) {
  const std::vector<double> pitches = fringe_pitches_px(p, size_px);
  const bool micro = p.kind == PatternKind::micro_phase;
  const double places = micro ? 256 : 1, step = std::max(1.0, size_px / places);
  double least = std::numeric_limits<double>::infinity();
  for (double apart = pitches[0]; apart < size_px; apart += pitches[0]) {
    for (double x = 0; x + apart < size_px; x += step) {
      double sum = 0;
      for (std::size_t m = 1; m < pitches.size(); ++m)
        sum += squared_distance(pitches[m], micro ? 1 : p.steps, x, x + apart);
      least = std::min(least, sum);
    }
  }
  return std::sqrt(least);
}

}  // namespace laterna
