#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/tile_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/tile_kernels.h"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace laterna::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::CappedTag<double, packet_size>;
using Floats = hn::Rebind<float, Doubles>;
using Ints = hn::Rebind<std::int32_t, Doubles>;
using V = hn::Vec<Doubles>;
using Mask = hn::Mask<Doubles>;
constexpr Doubles d;
constexpr Floats f;
constexpr Ints n;

HWY_INLINE V set(double x) { return hn::Set(d, x); }
HWY_INLINE V load(const double* from) { return hn::Load(d, from); }
HWY_INLINE void store(V x, double* to) { hn::Store(x, d, to); }
HWY_INLINE void store(V x, float* to) { hn::Store(hn::DemoteTo(f, x), f, to); }

HWY_INLINE V dot(V ax, V ay, V az, V bx, V by, V bz) {
  return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

// Row i of m times (x, y, z), and of m times (x, y, 1).
HWY_INLINE V row(const glm::dmat3& m, int i, V x, V y, V z) {
  return dot(set(m[0][i]), set(m[1][i]), set(m[2][i]), x, y, z);
}
HWY_INLINE V row(const glm::dmat3& m, int i, V x, V y) {
  return hn::Add(hn::Add(hn::Mul(set(m[0][i]), x), hn::Mul(set(m[1][i]), y)), set(m[2][i]));
}

// -1 where true, else 0.
HWY_INLINE void store(Mask mask, std::int32_t* to) {
  hn::Store(hn::DemoteTo(n, hn::IfThenElseZero(mask, set(-1))), n, to);
}

using Lanes = hn::CappedTag<float, packet_size>;
using Signs = hn::RebindToSigned<Lanes>;

HWY_INLINE hn::Mask<Lanes> nonzero(const std::int32_t* from) {
  return hn::MaskFromVec(
      hn::BitCast(Lanes(), hn::VecFromMask(Signs(), hn::Lt(hn::Load(Signs(), from), hn::Zero(Signs())))));
}

// |a - 2·b + c| > b/1000.
template <class D>
HWY_INLINE hn::Mask<D> bent(D w, hn::Vec<D> a, hn::Vec<D> b, hn::Vec<D> c) {
  const auto off = hn::Sub(hn::Add(a, c), hn::Add(b, b));
  return hn::Gt(hn::Abs(off), hn::Mul(hn::Set(w, 1e-3f), b));
}

bool rays_disagree(const RayPacket& rays) {
  const Lanes w;
  const Signs s;
  bool hit = false, missed = false, left_out = false, front = false, back = false, off = false;
  for (std::size_t i = 0; i < packet_size; i += hn::Lanes(w)) {
    const auto valid = nonzero(rays.valid + i);
    const auto none =
        hn::Eq(hn::Load(s, reinterpret_cast<const std::int32_t*>(rays.object) + i), hn::Set(s, -1));
    const auto miss = hn::MaskFromVec(hn::BitCast(w, hn::VecFromMask(s, none)));
    const auto here = hn::AndNot(miss, valid);
    const auto along =
        hn::Add(hn::Add(hn::Mul(hn::Load(w, rays.normal_x + i), hn::Load(w, rays.direction_x + i)),
                        hn::Mul(hn::Load(w, rays.normal_y + i), hn::Load(w, rays.direction_y + i))),
                hn::Mul(hn::Load(w, rays.normal_z + i), hn::Load(w, rays.direction_z + i)));
    hit |= !hn::AllFalse(w, here);
    missed |= !hn::AllFalse(w, hn::And(miss, valid));
    left_out |= !hn::AllTrue(w, valid);
    front |= !hn::AllFalse(w, hn::And(here, hn::Lt(along, hn::Zero(w))));
    back |= !hn::AllFalse(w, hn::And(here, hn::Gt(along, hn::Zero(w))));
  }
  if (missed && (hit || left_out)) return true;
  if (!hit) return false;
  if (front && back) return true;
  const hn::CappedTag<float, 2 * tile_edge> two_rows;
  for (std::size_t i = 0; i < 2 * tile_edge; i += hn::Lanes(two_rows)) {
    const float* t = rays.end + i;
    off |= !hn::AllFalse(two_rows, bent(two_rows, hn::LoadU(two_rows, t), hn::LoadU(two_rows, t + tile_edge),
                                        hn::LoadU(two_rows, t + 2 * tile_edge)));
  }
  const hn::CappedTag<float, 2> two;
  for (int j = 0; j < tile_edge; ++j) {
    for (std::size_t i = 0; i < 2; i += hn::Lanes(two)) {
      const float* t = rays.end + j * tile_edge + i;
      off |= !hn::AllFalse(two, bent(two, hn::LoadU(two, t), hn::LoadU(two, t + 1), hn::LoadU(two, t + 2)));
    }
  }
  return off;
}

std::uint32_t blocked_lanes(const RayPacket& rays) {
  const Lanes w;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < packet_size; i += hn::Lanes(w)) {
    const auto blocked = hn::And(nonzero(rays.valid + i), hn::Lt(hn::Load(w, rays.end + i), hn::Zero(w)));
    std::uint8_t part[8] = {};
    hn::StoreMaskBits(w, blocked, part);
    bits |= (std::uint32_t(part[0]) | std::uint32_t(part[1]) << 8) << i;
  }
  return bits;
}

void aim_tile(const glm::dmat3& m, const TileRays& directions, RayPacket& rays) {
  for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d)) {
    const V x = load(directions.x + i), y = load(directions.y + i);
    store(row(m, 0, x, y), rays.direction_x + i);
    store(row(m, 1, x, y), rays.direction_y + i);
    store(row(m, 2, x, y), rays.direction_z + i);
    store(hn::Eq(x, x), rays.valid + i);
  }
}

void refine_tile(const glm::dmat3& m, const glm::dvec3& camera_from_center, const glm::dvec3& camera_object,
                 const TileRays& directions, const TilePlanes& planes, const TileFloats& embree_depth,
                 TileSurface& surface) {
  const glm::dvec3 &c = camera_from_center, &o = camera_object;
  for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d)) {
    const V x = load(directions.x + i), y = load(directions.y + i);
    const V nx = load(planes.normal_x + i), ny = load(planes.normal_y + i), nz = load(planes.normal_z + i);
    const V rx = row(m, 0, x, y), ry = row(m, 1, x, y), rz = row(m, 2, x, y);
    const V slope = dot(nx, ny, nz, rx, ry, rz);
    V bx = hn::Zero(d), by = hn::Zero(d), bz = hn::Zero(d);  // the start beside the camera's centre
    if (directions.from_lens) {
      const V sx = load(directions.start_x_m + i), sy = load(directions.start_y_m + i);
      bx = row(m, 0, sx, sy, hn::Zero(d)), by = row(m, 1, sx, sy, hn::Zero(d)),
      bz = row(m, 2, sx, sy, hn::Zero(d));
    }
    const V height = dot(nx, ny, nz, hn::Add(set(c.x), bx), hn::Add(set(c.y), by), hn::Add(set(c.z), bz));
    const V plane = hn::Div(hn::Sub(load(planes.distance + i), height), slope);
    const V embree = hn::PromoteTo(d, hn::Load(f, embree_depth + i));
    const Mask near = hn::Le(hn::Abs(hn::Sub(plane, embree)), hn::Mul(set(1e-3), embree));
    const V depth = hn::IfThenElse(near, plane, embree);
    store(depth, surface.depth_m + i);
    store(hn::Add(hn::Add(set(o.x), bx), hn::Mul(depth, rx)), surface.x + i);
    store(hn::Add(hn::Add(set(o.y), by), hn::Mul(depth, ry)), surface.y + i);
    store(hn::Add(hn::Add(set(o.z), bz), hn::Mul(depth, rz)), surface.z + i);
    store(slope, surface.slope + i);
  }
}

HWY_INLINE V homogeneous(const double (&t)[4], V x, V y, V z) {
  return hn::Add(dot(set(t[0]), set(t[1]), set(t[2]), x, y, z), set(t[3]));
}

void project_tile(const LookupTerms& lookup, const TilePoints& points, TilePixels& pixels) {
  const V nan = set(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d)) {
    const V x = load(points.x + i), y = load(points.y + i), z = load(points.z + i);
    const V q = homogeneous(lookup.q, x, y, z), inverse_q = hn::Div(set(1), q);
    const Mask ahead = hn::Gt(q, set(0));
    const V u = hn::Mul(homogeneous(lookup.u, x, y, z), inverse_q);
    const V v = hn::Mul(homogeneous(lookup.v, x, y, z), inverse_q);
    store(hn::IfThenElse(ahead, u, nan), pixels.u_px + i);
    store(hn::IfThenElse(ahead, v, nan), pixels.v_px + i);
    store(q, pixels.q + i);
    store(set(lookup.pinhole_area), pixels.pixels_per_unit_area + i);
  }
}

HWY_INLINE Mask within(V x, double size) { return hn::And(hn::Ge(x, set(-0.5)), hn::Lt(x, set(size - 0.5))); }

HWY_INLINE V reason(Unlit why) { return set(double(int(why))); }

// The first reason, of those down to `outside`, as a number. In the reverse order, so that the first wins.
HWY_INLINE V first_reason(const LookupTerms& t, V u, V v, V q) {
  const Mask inside = hn::And(within(u, t.width), within(v, t.height));
  V why = reason(Unlit::lit);
  if (!t.clamp) why = hn::IfThenElse(inside, why, reason(Unlit::outside));
  why = hn::IfThenElse(hn::Gt(q, set(t.far_m)), reason(Unlit::beyond_far), why);
  why = hn::IfThenElse(hn::Lt(q, set(t.near_m)), reason(Unlit::before_near), why);
  why = hn::IfThenElse(hn::Eq(u, u), why, reason(Unlit::lens));
  return hn::IfThenElse(hn::Gt(q, set(0)), why, reason(Unlit::behind));
}

void light_tile(const LightTerms& t, const TilePoints& points, const TilePixels& pixels, TileLight& light,
                RayPacket& rays) {
  const glm::dvec3 &o = t.object_relative, &c = t.center_relative;
  for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d)) {
    const V x = load(points.x + i), y = load(points.y + i), z = load(points.z + i), q = load(pixels.q + i);
    const V nx = load(points.normal_x + i), ny = load(points.normal_y + i), nz = load(points.normal_z + i);
    const V px = hn::Add(row(t.world_from_object_linear, 0, x, y, z), set(o.x));
    const V py = hn::Add(row(t.world_from_object_linear, 1, x, y, z), set(o.y));
    const V pz = hn::Add(row(t.world_from_object_linear, 2, x, y, z), set(o.z));
    const V height = dot(nx, ny, nz, hn::Sub(set(c.x), px), hn::Sub(set(c.y), py), hn::Sub(set(c.z), pz));
    V why = first_reason(t.lookup, load(pixels.u_px + i), load(pixels.v_px + i), q);
    V above = height, margin = load(points.margin_m + i);
    if (t.back_face) {
      const Mask faces = hn::And(hn::Gt(height, set(0)), hn::Gt(load(points.front + i), set(0)));
      const Mask hidden = hn::AndNot(faces, hn::Eq(why, reason(Unlit::lit)));
      why = hn::IfThenElse(hidden, reason(Unlit::back_face), why);
    } else {
      const Mask behind = hn::Lt(height, set(0));
      above = hn::IfThenElse(behind, hn::Neg(height), height);
      margin = hn::IfThenElse(behind, hn::Neg(margin), margin);
    }
    const Mask lit = hn::Eq(why, reason(Unlit::lit));
    const V flux = hn::Mul(set(t.flux_per_pixel_lm), load(pixels.pixels_per_unit_area + i));
    const V white =
        t.irradiance ? hn::Div(hn::Mul(flux, above), hn::Mul(hn::Mul(q, q), q)) : set(t.facing_at_1_m_lx);
    store(hn::IfThenElseZero(lit, white), light.white_lx + i);
    hn::Store(hn::DemoteTo(n, why), n, light.why + i);
    const V sx = hn::Add(px, hn::Mul(margin, nx)), sy = hn::Add(py, hn::Mul(margin, ny)),
            sz = hn::Add(pz, hn::Mul(margin, nz));
    store(sx, rays.origin_x + i), store(sy, rays.origin_y + i), store(sz, rays.origin_z + i);
    store(hn::Sub(set(c.x), sx), rays.direction_x + i);
    store(hn::Sub(set(c.y), sy), rays.direction_y + i);
    store(hn::Sub(set(c.z), sz), rays.direction_z + i);
    if (t.shadow) store(lit, rays.valid + i);
  }
}

}  // namespace
}  // namespace laterna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace laterna {

namespace {
HWY_EXPORT(rays_disagree);
HWY_EXPORT(blocked_lanes);
HWY_EXPORT(aim_tile);
HWY_EXPORT(refine_tile);
HWY_EXPORT(project_tile);
HWY_EXPORT(light_tile);
}  // namespace

bool rays_disagree(const RayPacket& rays) { return HWY_DYNAMIC_DISPATCH(rays_disagree)(rays); }

std::uint32_t blocked_lanes(const RayPacket& rays) { return HWY_DYNAMIC_DISPATCH(blocked_lanes)(rays); }

void aim_tile(const glm::dmat3& world_from_device, const TileRays& directions, RayPacket& rays) {
  HWY_DYNAMIC_DISPATCH(aim_tile)(world_from_device, directions, rays);
}

void refine_tile(const glm::dmat3& object_from_device, const glm::dvec3& camera_from_center,
                 const glm::dvec3& camera_object, const TileRays& directions, const TilePlanes& planes,
                 const TileFloats& embree_depth, TileSurface& surface) {
  HWY_DYNAMIC_DISPATCH(refine_tile)
  (object_from_device, camera_from_center, camera_object, directions, planes, embree_depth, surface);
}

void project_tile(const LookupTerms& lookup, const TilePoints& points, TilePixels& pixels) {
  HWY_DYNAMIC_DISPATCH(project_tile)(lookup, points, pixels);
}

void light_tile(const LightTerms& terms, const TilePoints& points, const TilePixels& pixels, TileLight& light,
                RayPacket& shadow_rays) {
  HWY_DYNAMIC_DISPATCH(light_tile)(terms, points, pixels, light, shadow_rays);
}

}  // namespace laterna
#endif
