// The hot loops of the solver. Each is compiled for several instruction sets, with the same bits from all.
#pragma once

#include <cstddef>

namespace laterna {

inline constexpr std::size_t group_points = 128;  ///< points that are worked on together

/// A pinhole at a pose in plain numbers: x_device = r·x + t, r row-major.
struct PlainPinhole {
  double fx, fy, cx, cy, r[9], t[3];
};

/// What up to 128 points give on the way to their rows: r·x, 1/z, x/z and y/z of x_device, residuals in
/// pixels (projected - measured), and each row's weight, which the caller sets.
struct GroupTerms {
  double rx[group_points], ry[group_points], rz[group_points], iz[group_points], a[group_points],
      b[group_points], du[group_points], dv[group_points], weight[group_points];
};

/// All but the weights. False where a point lies behind the device.
bool pinhole_terms(const PlainPinhole& pinhole, const double* x, const double* y, const double* z,
                   const double* u, const double* v, std::size_t count, GroupTerms& terms);

/// The rows of [J | r] in tangent order (projection_rows.h): columns[2·c + row][i]. Only what is not zero by
/// RowSupport is written: fx and cx have a first row, fy and cy a second.
void pinhole_columns(const PlainPinhole& pinhole, std::size_t count, const GroupTerms& terms,
                     double* const* columns);

/// The terms of LENSMODEL_OPENCV4: radial k1, k2, tangential p1, p2.
struct OpenCv4 {
  double k1, k2, p1, p2;
};

/// What that lens makes of a, b: x = a·ρ + 2·p1·a·b + p2·(r² + 2a²), y = b·ρ + p1·(r² + 2b²) + 2·p2·a·b with
/// r² = a² + b², ρ = 1 + k1·r² + k2·r⁴ (OpenCV's documentation of camera calibration), and its derivatives;
/// dx/db = dy/da.
struct WarpTerms {
  double x[group_points], y[group_points], dx_da[group_points], dx_db[group_points], dy_db[group_points];
};

/// Fills `warp`, and writes the residuals over the pinhole's in `terms`.
void opencv4_terms(const PlainPinhole& pinhole, const OpenCv4& lens, const double* u, const double* v,
                   std::size_t count, GroupTerms& terms, WarpTerms& warp);

/// As pinhole_columns(), with k1, k2, p1, p2 between cy and the rotation: 15 columns.
void opencv4_columns(const PlainPinhole& pinhole, std::size_t count, const GroupTerms& terms,
                     const WarpTerms& warp, double* const* columns);

/// dots[j] = Σ v·columns[j] over `count` rows, a multiple of 8, for four columns at once.
void dot4(const double* v, double* const* columns, std::size_t count, double* dots);

/// columns[j] -= factors[j]·v, likewise.
void subtract4(const double* v, double* const* columns, std::size_t count, const double* factors);

}  // namespace laterna
