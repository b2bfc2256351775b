#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "calib/row_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "calib/row_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace laterna::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
constexpr std::size_t sum_lanes = 8;  // a dot product is this many sums, on every instruction set
using Wide = hn::CappedTag<double, sum_lanes>;
using Single = hn::CappedTag<double, 1>;

// Calls body(i, tag) for whole vectors, then one by one.
template <class Body>
HWY_INLINE void for_all(std::size_t count, const Body& body) {
  std::size_t i = 0;
  for (; i + hn::Lanes(Wide()) <= count; i += hn::Lanes(Wide())) body(i, Wide());
  for (; i < count; ++i) body(i, Single());
}

template <class D>
HWY_INLINE hn::Vec<D> combine(D d, const double* r, hn::Vec<D> x, hn::Vec<D> y, hn::Vec<D> z) {
  const auto xy = hn::Add(hn::Mul(hn::Set(d, r[0]), x), hn::Mul(hn::Set(d, r[1]), y));
  return hn::Add(xy, hn::Mul(hn::Set(d, r[2]), z));
}

// f·a + c - u.
template <class D>
HWY_INLINE hn::Vec<D> residual(D d, double focal, hn::Vec<D> a, double center, hn::Vec<D> u) {
  return hn::Sub(hn::Add(hn::Mul(hn::Set(d, focal), a), hn::Set(d, center)), u);
}

// True where all lie in front.
template <class D>
HWY_INLINE bool terms_at(D d, const PlainPinhole& p, const double* x, const double* y, const double* z,
                         const double* u, const double* v, std::size_t i, GroupTerms& g) {
  const auto px = hn::LoadU(d, x + i), py = hn::LoadU(d, y + i), pz = hn::LoadU(d, z + i);
  const auto rx = combine(d, p.r, px, py, pz), ry = combine(d, p.r + 3, px, py, pz),
             rz = combine(d, p.r + 6, px, py, pz);
  const auto iz = hn::Div(hn::Set(d, 1.0), hn::Add(rz, hn::Set(d, p.t[2])));
  const auto a = hn::Mul(hn::Add(rx, hn::Set(d, p.t[0])), iz);
  const auto b = hn::Mul(hn::Add(ry, hn::Set(d, p.t[1])), iz);
  hn::StoreU(rx, d, g.rx + i), hn::StoreU(ry, d, g.ry + i), hn::StoreU(rz, d, g.rz + i);
  hn::StoreU(iz, d, g.iz + i), hn::StoreU(a, d, g.a + i), hn::StoreU(b, d, g.b + i);
  hn::StoreU(residual(d, p.fx, a, p.cx, hn::LoadU(d, u + i)), d, g.du + i);
  hn::StoreU(residual(d, p.fy, b, p.cy, hn::LoadU(d, v + i)), d, g.dv + i);
  return hn::AllTrue(d, hn::And(hn::Gt(iz, hn::Zero(d)), hn::Lt(iz, hn::Set(d, 1e300))));
}

bool pinhole_terms(const PlainPinhole& p, const double* x, const double* y, const double* z, const double* u,
                   const double* v, std::size_t count, GroupTerms& g) {
  bool all = true;
  for_all(count, [&](std::size_t i, auto d) { all &= terms_at(d, p, x, y, z, u, v, i, g); });
  return all;
}

// d(u)/dx_device = (gx, 0, -gx·a), d(v)/dx_device = (0, gy, -gy·b); a left rotation moves x_device by w ×
// r·x.
template <class D>
HWY_INLINE void columns_at(D d, const PlainPinhole& p, const GroupTerms& g, std::size_t i,
                           double* const* columns) {
  const auto write = [&](int c, int row, hn::Vec<D> value) {
    hn::StoreU(value, d, columns[2 * c + row] + i);
  };
  const auto rx = hn::LoadU(d, g.rx + i), ry = hn::LoadU(d, g.ry + i), rz = hn::LoadU(d, g.rz + i);
  const auto a = hn::LoadU(d, g.a + i), b = hn::LoadU(d, g.b + i), iz = hn::LoadU(d, g.iz + i);
  const auto w = hn::LoadU(d, g.weight + i);
  const auto gx = hn::Mul(hn::Mul(w, hn::Set(d, p.fx)), iz), gy = hn::Mul(hn::Mul(w, hn::Set(d, p.fy)), iz);
  const auto ga = hn::Neg(hn::Mul(gx, a)), gb = hn::Neg(hn::Mul(gy, b));
  write(0, 0, hn::Mul(w, a)), write(1, 1, hn::Mul(w, b));
  write(2, 0, w), write(3, 1, w);
  write(4, 0, hn::Mul(ry, ga)), write(4, 1, hn::Sub(hn::Mul(ry, gb), hn::Mul(rz, gy)));
  write(5, 0, hn::Sub(hn::Mul(rz, gx), hn::Mul(rx, ga))), write(5, 1, hn::Neg(hn::Mul(rx, gb)));
  write(6, 0, hn::Neg(hn::Mul(ry, gx))), write(6, 1, hn::Mul(rx, gy));
  write(7, 0, gx), write(8, 1, gy);
  write(9, 0, ga), write(9, 1, gb);
  write(10, 0, hn::Mul(w, hn::LoadU(d, g.du + i))), write(10, 1, hn::Mul(w, hn::LoadU(d, g.dv + i)));
}

void pinhole_columns(const PlainPinhole& p, std::size_t count, const GroupTerms& g, double* const* columns) {
  for_all(count, [&](std::size_t i, auto d) { columns_at(d, p, g, i, columns); });
}

template <class D>
HWY_INLINE void warp_at(D d, const PlainPinhole& p, const OpenCv4& lens, const double* u, const double* v,
                        std::size_t i, GroupTerms& g, WarpTerms& warp) {
  const auto a = hn::LoadU(d, g.a + i), b = hn::LoadU(d, g.b + i);
  const auto k1 = hn::Set(d, lens.k1), k2 = hn::Set(d, lens.k2), one = hn::Set(d, 1.0), two = hn::Set(d, 2.0);
  const auto p1 = hn::Set(d, lens.p1), p2 = hn::Set(d, lens.p2);
  const auto aa = hn::Mul(a, a), bb = hn::Mul(b, b), ab2 = hn::Mul(two, hn::Mul(a, b)), r2 = hn::Add(aa, bb);
  const auto rho = hn::Add(one, hn::Mul(r2, hn::Add(k1, hn::Mul(k2, r2))));
  const auto slope = hn::Mul(two, hn::Add(k1, hn::Mul(hn::Add(k2, k2), r2)));  // dρ/da = slope·a
  const auto x =
      hn::Add(hn::Add(hn::Mul(a, rho), hn::Mul(p1, ab2)), hn::Mul(p2, hn::Add(r2, hn::Mul(two, aa))));
  const auto y =
      hn::Add(hn::Add(hn::Mul(b, rho), hn::Mul(p1, hn::Add(r2, hn::Mul(two, bb)))), hn::Mul(p2, ab2));
  const auto ta = hn::Mul(two, a), tb = hn::Mul(two, b), six = hn::Set(d, 6.0);
  const auto xa =
      hn::Add(hn::Add(rho, hn::Mul(aa, slope)), hn::Add(hn::Mul(p1, tb), hn::Mul(p2, hn::Mul(six, a))));
  const auto xb = hn::Add(hn::Mul(hn::Mul(a, b), slope), hn::Add(hn::Mul(p1, ta), hn::Mul(p2, tb)));
  const auto yb =
      hn::Add(hn::Add(rho, hn::Mul(bb, slope)), hn::Add(hn::Mul(p1, hn::Mul(six, b)), hn::Mul(p2, ta)));
  hn::StoreU(x, d, warp.x + i), hn::StoreU(y, d, warp.y + i), hn::StoreU(xa, d, warp.dx_da + i);
  hn::StoreU(xb, d, warp.dx_db + i), hn::StoreU(yb, d, warp.dy_db + i);
  hn::StoreU(residual(d, p.fx, x, p.cx, hn::LoadU(d, u + i)), d, g.du + i);
  hn::StoreU(residual(d, p.fy, y, p.cy, hn::LoadU(d, v + i)), d, g.dv + i);
}

void opencv4_terms(const PlainPinhole& p, const OpenCv4& lens, const double* u, const double* v,
                   std::size_t count, GroupTerms& g, WarpTerms& warp) {
  for_all(count, [&](std::size_t i, auto d) { warp_at(d, p, lens, u, v, i, g, warp); });
}

// One row of d/dx_device = (e, f, -(e·a + f·b)), and a left rotation's (r·x) × that, into columns 8 to 13.
template <class D, class Write>
HWY_INLINE void placement_at(D d, const GroupTerms& g, std::size_t i, int row, hn::Vec<D> e, hn::Vec<D> f,
                             const Write& write) {
  const auto rx = hn::LoadU(d, g.rx + i), ry = hn::LoadU(d, g.ry + i), rz = hn::LoadU(d, g.rz + i);
  const auto h = hn::Neg(hn::Add(hn::Mul(e, hn::LoadU(d, g.a + i)), hn::Mul(f, hn::LoadU(d, g.b + i))));
  write(8, row, hn::Sub(hn::Mul(ry, h), hn::Mul(rz, f)));
  write(9, row, hn::Sub(hn::Mul(rz, e), hn::Mul(rx, h)));
  write(10, row, hn::Sub(hn::Mul(rx, f), hn::Mul(ry, e)));
  write(11, row, e), write(12, row, f), write(13, row, h);
}

template <class D>
HWY_INLINE void warped_columns_at(D d, const PlainPinhole& p, const GroupTerms& g, const WarpTerms& warp,
                                  std::size_t i, double* const* columns) {
  const auto write = [&](int c, int row, hn::Vec<D> value) {
    hn::StoreU(value, d, columns[2 * c + row] + i);
  };
  const auto a = hn::LoadU(d, g.a + i), b = hn::LoadU(d, g.b + i), iz = hn::LoadU(d, g.iz + i);
  const auto w = hn::LoadU(d, g.weight + i), two = hn::Set(d, 2.0);
  const auto wx = hn::Mul(w, hn::Set(d, p.fx)), wy = hn::Mul(w, hn::Set(d, p.fy));
  const auto aa = hn::Mul(a, a), bb = hn::Mul(b, b), ab2 = hn::Mul(two, hn::Mul(a, b)), r2 = hn::Add(aa, bb);
  write(0, 0, hn::Mul(w, hn::LoadU(d, warp.x + i))), write(1, 1, hn::Mul(w, hn::LoadU(d, warp.y + i)));
  write(2, 0, w), write(3, 1, w);
  const auto xr = hn::Mul(hn::Mul(wx, a), r2), yr = hn::Mul(hn::Mul(wy, b), r2);
  write(4, 0, xr), write(4, 1, yr);
  write(5, 0, hn::Mul(xr, r2)), write(5, 1, hn::Mul(yr, r2));
  write(6, 0, hn::Mul(wx, ab2)), write(6, 1, hn::Mul(wy, hn::Add(r2, hn::Mul(two, bb))));
  write(7, 0, hn::Mul(wx, hn::Add(r2, hn::Mul(two, aa)))), write(7, 1, hn::Mul(wy, ab2));
  const auto gx = hn::Mul(wx, iz), gy = hn::Mul(wy, iz), xb = hn::LoadU(d, warp.dx_db + i);
  placement_at(d, g, i, 0, hn::Mul(gx, hn::LoadU(d, warp.dx_da + i)), hn::Mul(gx, xb), write);
  placement_at(d, g, i, 1, hn::Mul(gy, xb), hn::Mul(gy, hn::LoadU(d, warp.dy_db + i)), write);
  write(14, 0, hn::Mul(w, hn::LoadU(d, g.du + i))), write(14, 1, hn::Mul(w, hn::LoadU(d, g.dv + i)));
}

void opencv4_columns(const PlainPinhole& p, std::size_t count, const GroupTerms& g, const WarpTerms& warp,
                     double* const* columns) {
  for_all(count, [&](std::size_t i, auto d) { warped_columns_at(d, p, g, warp, i, columns); });
}

void dot4(const double* v, double* const* columns, std::size_t count, double* dots) {
  constexpr Wide d;
  constexpr std::size_t parts = sum_lanes / hn::MaxLanes(d);
  hn::Vec<Wide> sum[4][parts];
  for (auto& column : sum)
    for (auto& part : column) part = hn::Zero(d);
  for (std::size_t i = 0; i < count; i += sum_lanes) {
    for (std::size_t k = 0; k < parts; ++k) {
      const std::size_t at = i + k * hn::MaxLanes(d);
      const auto x = hn::LoadU(d, v + at);
      for (int j = 0; j < 4; ++j) sum[j][k] = hn::Add(sum[j][k], hn::Mul(x, hn::LoadU(d, columns[j] + at)));
    }
  }
  for (int j = 0; j < 4; ++j) {
    double s[sum_lanes];
    for (std::size_t k = 0; k < parts; ++k) hn::StoreU(sum[j][k], d, s + k * hn::MaxLanes(d));
    dots[j] = ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
  }
}

void subtract4(const double* v, double* const* columns, std::size_t count, const double* factors) {
  constexpr Wide d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto x = hn::LoadU(d, v + i);
    for (int j = 0; j < 4; ++j) {
      double* y = columns[j] + i;
      hn::StoreU(hn::Sub(hn::LoadU(d, y), hn::Mul(hn::Set(d, factors[j]), x)), d, y);
    }
  }
}

}  // namespace
}  // namespace laterna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace laterna {

namespace {
HWY_EXPORT(pinhole_terms);
HWY_EXPORT(pinhole_columns);
HWY_EXPORT(opencv4_terms);
HWY_EXPORT(opencv4_columns);
HWY_EXPORT(dot4);
HWY_EXPORT(subtract4);
}  // namespace

bool pinhole_terms(const PlainPinhole& p, const double* x, const double* y, const double* z, const double* u,
                   const double* v, std::size_t count, GroupTerms& g) {
  return HWY_DYNAMIC_DISPATCH(pinhole_terms)(p, x, y, z, u, v, count, g);
}

void pinhole_columns(const PlainPinhole& p, std::size_t count, const GroupTerms& g, double* const* columns) {
  HWY_DYNAMIC_DISPATCH(pinhole_columns)(p, count, g, columns);
}

void opencv4_terms(const PlainPinhole& p, const OpenCv4& lens, const double* u, const double* v,
                   std::size_t count, GroupTerms& g, WarpTerms& warp) {
  HWY_DYNAMIC_DISPATCH(opencv4_terms)(p, lens, u, v, count, g, warp);
}

void opencv4_columns(const PlainPinhole& p, std::size_t count, const GroupTerms& g, const WarpTerms& warp,
                     double* const* columns) {
  HWY_DYNAMIC_DISPATCH(opencv4_columns)(p, count, g, warp, columns);
}

void dot4(const double* v, double* const* columns, std::size_t count, double* dots) {
  HWY_DYNAMIC_DISPATCH(dot4)(v, columns, count, dots);
}

void subtract4(const double* v, double* const* columns, std::size_t count, const double* factors) {
  HWY_DYNAMIC_DISPATCH(subtract4)(v, columns, count, factors);
}

}  // namespace laterna
#endif
