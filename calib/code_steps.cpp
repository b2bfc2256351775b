#include "calib/code_steps.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace laterna {

namespace {

constexpr double least_asymmetry = 0.05, least_deviations = 6;
constexpr double least_pixels = 40, least_edges = 6;  // around an edge; of each kind
constexpr int parts = 5;                              // four quadrants, and all of them

using Counts = std::vector<double>;

struct Sample {
  double n = 0, sum = 0, squares = 0, shot = 0;

  void add(double asymmetry, double pixels) {
    ++n, sum += asymmetry, squares += asymmetry * asymmetry, shot += 1 / pixels;
  }
  double mean() const { return sum / n; }
  // Of one edge: the spread over edges, no less than counting makes it.
  double variance() const { return std::max((squares - sum * sum / n) / (n - 1), shot / n); }
};

// Of two columns on each side of an edge at x; where edges are 8 columns apart and more, without what a slope
// of the counts makes, by the two columns beyond, whose middles are three times as far apart. NaN: too few
// pixels, or beyond the image.
double asymmetry_at(const Counts& counts, std::size_t x, bool without_slope) {
  const std::size_t reach = without_slope ? 4 : 2;
  if (x < reach || x + reach > counts.size()) return NAN;
  const double left = counts[x - 2] + counts[x - 1], right = counts[x] + counts[x + 1];
  if (left + right < least_pixels) return NAN;
  const double slope =
      without_slope ? (counts[x - 4] + counts[x - 3] - counts[x + 2] - counts[x + 3]) / 3 : 0;
  return (left - right - slope) / (left + right);
}

// Bits from k on against finer ones; none where there are too few edges.
std::optional<CodeSteps> steps_at(const Counts& counts, int k) {
  Sample coarse, fine;
  for (std::size_t x = 2; x + 2 <= counts.size(); ++x) {
    const int bit = std::countr_zero(x);
    if (bit < std::min(2, k - 1)) continue;
    const double asymmetry = asymmetry_at(counts, x, k >= 3);
    if (!std::isnan(asymmetry))
      (bit >= k ? coarse : fine).add(asymmetry, counts[x - 2] + counts[x - 1] + counts[x] + counts[x + 1]);
  }
  if (coarse.n < least_edges || fine.n < least_edges) return std::nullopt;
  const double asymmetry = coarse.mean() - fine.mean();
  const double variance = std::max(coarse.variance(), fine.variance());
  return CodeSteps{false, k, asymmetry, asymmetry / std::sqrt(variance * (1 / coarse.n + 1 / fine.n))};
}

// The worst over k.
void search(const Counts& counts, bool rows, std::optional<CodeSteps>& worst) {
  for (int k = 1; k < int(std::bit_width(counts.size())); ++k) {
    auto steps = steps_at(counts, k);
    if (!steps || std::abs(steps->asymmetry) < least_asymmetry ||
        std::abs(steps->deviations) < least_deviations)
      continue;
    if (worst && std::abs(worst->deviations) >= std::abs(steps->deviations)) continue;
    worst = steps, worst->rows = rows;
  }
}

}  // namespace

std::optional<CodeSteps> code_steps(const DecodedMap& decoded, glm::ivec2 size) {
  std::array<Counts, parts> columns, rows;
  columns.fill(Counts(std::size_t(size.x), 0.0)), rows.fill(Counts(std::size_t(size.y), 0.0));
  for (std::size_t i = 0; i < decoded.valid.values.size(); ++i) {
    if (!decoded.valid.values[i]) continue;
    const int u = std::clamp(int(std::floor(decoded.u_px.values[i] + 0.5)), 0, size.x - 1);
    const int v = std::clamp(int(std::floor(decoded.v_px.values[i] + 0.5)), 0, size.y - 1);
    const std::size_t quadrant = (2 * u >= size.x) + 2 * std::size_t(2 * v >= size.y);
    ++columns[quadrant][std::size_t(u)], ++rows[quadrant][std::size_t(v)];
  }
  std::optional<CodeSteps> worst;
  for (auto* axis : {&columns, &rows}) {
    Counts& all = axis->back();
    for (std::size_t q = 0; q + 1 < parts; ++q)
      std::transform(all.begin(), all.end(), (*axis)[q].begin(), all.begin(), std::plus<>());
    for (const Counts& counts : *axis) search(counts, axis == &rows, worst);
  }
  return worst;
}

}  // namespace laterna
