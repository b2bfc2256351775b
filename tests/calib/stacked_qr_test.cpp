#include "calib/stacked_qr.h"

#include "sim/parallel.h"
#include "tests/testing.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace laterna {
namespace {

using Matrix = Eigen::MatrixXd;

// Rows 2i and 2i+1 (or i) of `a` are item i's.
StackedRows rows_of_matrix(const Matrix& a, int rows_per_item) {
  StackedRows rows;
  rows.items = std::size_t(a.rows() / rows_per_item);
  rows.rows_per_item = rows_per_item;
  rows.columns = int(a.cols());
  rows.fill = [&a, rows_per_item](std::size_t begin, std::size_t end, const RowBlock& block) {
    for (std::size_t i = begin; i < end; ++i)
      for (int r = 0; r < rows_per_item; ++r)
        for (int c = 0; c < a.cols(); ++c)
          block.column(c, r)[i - begin] = a(Eigen::Index(i) * rows_per_item + r, c);
    return true;
  };
  return rows;
}

Matrix as_matrix(const std::vector<double>& r, Eigen::Index n) {
  return Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(r.data(), n, n);
}

Matrix random_matrix(Eigen::Index rows, Eigen::Index columns) {
  auto random = testing::generator();
  std::normal_distribution<double> normal;
  return Matrix::NullaryExpr(rows, columns, [&] { return normal(random); });
}

// Both factors with positive diagonals.
Matrix positive(Matrix r) {
  for (Eigen::Index i = 0; i < r.rows(); ++i)
    if (r(i, i) < 0) r.row(i) *= -1;
  return r;
}

Matrix reference(const Matrix& a) {
  const Matrix packed = Eigen::HouseholderQR<Matrix>(a).matrixQR().topRows(a.cols());
  return positive(packed.triangularView<Eigen::Upper>());
}

TEST(StackedQr, ByHand) {
  const Matrix a =
      (Matrix(2, 2) << 3, 1, 4, 2).finished();  // |(3,4)| = 5, (3·1 + 4·2)/5 = 2.2, det 2 / 5 = 0.4
  const Matrix r = positive(as_matrix(*triangular_factor(rows_of_matrix(a, 1)), 2));
  EXPECT_NEAR(r(0, 0), 5, 1e-15);
  EXPECT_NEAR(r(0, 1), 2.2, 1e-15);
  EXPECT_NEAR(r(1, 1), 0.4, 1e-15);
  EXPECT_EQ(r(1, 0), 0);
}

TEST(StackedQr, EqualsEigensFactor) {
  for (const Eigen::Index items : {1, 7, 127, 128, 129, 4096, 9001}) {
    for (const int per_item : {1, 2}) {
      const Matrix a = random_matrix(items * per_item, 11);
      const Matrix r = as_matrix(*triangular_factor(rows_of_matrix(a, per_item)), 11);
      // Rounding grows with √rows: 1e-12 of a norm near √rows.
      EXPECT_LT((r.transpose() * r - a.transpose() * a).norm(), 1e-12 * a.squaredNorm()) << items;
      if (items * per_item >= 11) {
        EXPECT_LT((positive(r) - reference(a)).norm(), 1e-12 * a.norm()) << items;
      }
    }
  }
}

TEST(StackedQr, SupportChangesNothingButTime) {
  Matrix a = random_matrix(2 * 5000, 5);
  for (Eigen::Index i = 0; i < a.rows(); ++i) a(i, i % 2 == 0 ? 1 : 0) = 0;
  StackedRows rows = rows_of_matrix(a, 2);
  rows.support = {RowSupport::first, RowSupport::second, RowSupport::both, RowSupport::both,
                  RowSupport::both};
  const Matrix r = as_matrix(*triangular_factor(rows), 5);
  EXPECT_LT((positive(r) - reference(a)).norm(), 1e-12 * a.norm());
}

TEST(StackedQr, KeepsDigitsThatNormalEquationsLose) {
  Matrix a = random_matrix(5000, 3);
  a.col(2) = a.col(0) + 1e-10 * a.col(2);  // AᵀA holds 1e-20 relative to 1: nothing
  const Matrix r = positive(as_matrix(*triangular_factor(rows_of_matrix(a, 1)), 3));
  EXPECT_NEAR(r(2, 2) / reference(a)(2, 2), 1, 1e-4);  // 1e-16/1e-10, and room for √rows
}

TEST(StackedQr, SameBitsForAnyNumberOfThreads) {
  const Matrix a = random_matrix(2 * 20000, 6);
  set_thread_count(1);
  const auto one = *triangular_factor(rows_of_matrix(a, 2));
  set_thread_count(0);
  EXPECT_EQ(one, *triangular_factor(rows_of_matrix(a, 2)));
}

TEST(StackedQr, ARowThatCannotBeMadeGivesNone) {
  const Matrix a = random_matrix(10000, 3);
  StackedRows rows = rows_of_matrix(a, 1);
  const auto fill = rows.fill;
  rows.fill = [&](std::size_t begin, std::size_t end, const RowBlock& block) {
    return fill(begin, end, block) && !(begin <= 9000 && 9000 < end);
  };
  EXPECT_FALSE(triangular_factor(rows));
}

TEST(StackedQr, NoRowsAndZeroColumns) {
  const Matrix nothing(0, 3);
  EXPECT_EQ(*triangular_factor(rows_of_matrix(nothing, 1)), std::vector<double>(9, 0.0));
  Matrix a = random_matrix(100, 3);
  a.col(1).setZero();
  const Matrix r = as_matrix(*triangular_factor(rows_of_matrix(a, 1)), 3);
  EXPECT_LT((r.transpose() * r - a.transpose() * a).norm(), 1e-12 * a.squaredNorm());
}

}  // namespace
}  // namespace laterna
