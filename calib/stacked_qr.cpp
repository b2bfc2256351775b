#include "calib/stacked_qr.h"

#include "calib/row_kernels.h"
#include "sim/parallel.h"

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr std::size_t block_items = 128, chunk_items = 4096;
constexpr std::size_t lanes = 8;

struct Span {
  std::size_t begin, end;
};

Span span_of(RowSupport support, std::size_t half, std::size_t rows) {
  if (support == RowSupport::first) return {0, half};
  if (support == RowSupport::second) return {half, rows};
  return {0, rows};
}

bool disjoint(RowSupport a, RowSupport b) { return a != b && a != RowSupport::both && b != RowSupport::both; }

// [R; block] → R: reflection k has the vector (v0 at R's row k; column k of the block) and touches nothing
// else.
void fold(std::vector<double>& r, double* block, std::size_t rows, std::size_t stride, int columns,
          const std::vector<RowSupport>& support) {
  const std::size_t half = rows / 2;
  std::vector<int> others(columns);
  for (int k = 0; k < columns; ++k) {
    const Span span = span_of(support[k], half, rows);
    const std::size_t count = span.end - span.begin;
    double* v = block + k * stride + span.begin;
    double* self[4] = {v, v, v, v};
    double dots[4], factors[4];
    dot4(v, self, count, dots);
    const double squared = dots[0];
    if (squared == 0) continue;
    const double alpha = r[k * columns + k];
    const double beta = -std::copysign(std::sqrt(alpha * alpha + squared), alpha);
    const double v0 = alpha - beta, scale = 2 / (v0 * v0 + squared);
    r[k * columns + k] = beta;
    int n = 0;
    for (int j = k + 1; j < columns; ++j) {
      if (!disjoint(support[k], support[j])) others[n++] = j;
    }
    for (int first = 0; first < n; first += 4) {
      double* group[4];
      for (int j = 0; j < 4; ++j) group[j] = block + others[std::min(first + j, n - 1)] * stride + span.begin;
      dot4(v, group, count, dots);
      for (int j = 0; j < 4; ++j) {
        if (first + j >= n) {
          factors[j] = 0;
          continue;
        }
        double& top = r[k * columns + others[first + j]];
        factors[j] = scale * (v0 * top + dots[j]);
        top -= factors[j] * v0;
      }
      subtract4(v, group, count, factors);
    }
  }
}

// The factor of the items [begin, end); empty where a fill failed.
std::vector<double> factor_of_chunk(const StackedRows& a, const std::vector<RowSupport>& support,
                                    std::size_t begin, std::size_t end) {
  const std::size_t rows = block_items * a.rows_per_item;
  std::vector<double> r(std::size_t(a.columns) * a.columns, 0.0);
  std::vector<double> block(rows * a.columns);
  for (std::size_t i = begin; i < end; i += block_items) {
    std::fill(block.begin(), block.end(), 0.0);
    if (!a.fill(i, std::min(end, i + block_items), {block.data(), rows, block_items})) return {};
    fold(r, block.data(), rows, rows, a.columns, support);
  }
  return r;
}

}  // namespace

std::optional<std::vector<double>> triangular_factor(const StackedRows& a) {
  const int c = a.columns;
  std::vector<RowSupport> support = a.support;
  if (a.rows_per_item != 2) support.clear();
  support.resize(c, RowSupport::both);
  const std::size_t chunks = (a.items + chunk_items - 1) / chunk_items;
  std::vector<std::vector<double>> factors(chunks);
  parallel_for(chunks, [&](std::size_t k) {
    const std::size_t begin = k * chunk_items;
    factors[k] = factor_of_chunk(a, support, begin, std::min(a.items, begin + chunk_items));
  });

  std::vector<double> r(std::size_t(c) * c, 0.0);
  const std::size_t padded = (std::size_t(c) + lanes - 1) / lanes * lanes;
  std::vector<double> block(padded * c);
  const std::vector<RowSupport> everywhere(c, RowSupport::both);
  for (const auto& factor : factors) {
    if (factor.empty()) return std::nullopt;
    std::fill(block.begin(), block.end(), 0.0);
    for (int row = 0; row < c; ++row)
      for (int column = row; column < c; ++column) block[column * padded + row] = factor[row * c + column];
    fold(r, block.data(), padded, padded, c, everywhere);
  }
  return r;
}

}  // namespace laterna
