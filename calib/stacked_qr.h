// The triangular factor of very many rows, without holding the rows.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace laterna {

/// Where a filler writes: row r (0 or 1) of item i, column c, stands at
/// values[c·column_stride + r·second_row + i], i counted from the block's first item.
struct RowBlock {
  double* values;
  std::size_t column_stride, second_row;
  double* column(int c, int row = 0) const { return values + c * column_stride + row * second_row; }
};

/// Which of an item's two rows a column may be nonzero in; a promise that saves time.
enum class RowSupport { both, first, second };

/// Many rows, described by a function that writes those of a few items at a time.
struct StackedRows {
  std::size_t items = 0;
  int rows_per_item = 2;            ///< 1 or 2
  int columns = 0;                  ///< a right-hand side counts as the last column
  std::vector<RowSupport> support;  ///< one per column; empty: `both` everywhere
  /// Writes the rows of items [begin, end) into a block of zeros; false: an item has no rows. Called from
  /// several threads.
  std::function<bool(std::size_t begin, std::size_t end, const RowBlock& block)> fill;
};

/// R, row-major columns×columns, upper triangular, with RᵀR = AᵀA for the stacked rows A = Q·R; rows of R may
/// have either sign. Householder reflections on blocks of 128 items, the previous R on top of each (Golub and
/// Van Loan, Matrix Computations, 5.2); chunks of 4096 items run in parallel and are folded in order, so the
/// bits do not depend on the number of threads. None where a fill returned false.
std::optional<std::vector<double>> triangular_factor(const StackedRows& rows);

}  // namespace laterna
