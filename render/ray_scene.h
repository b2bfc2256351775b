// Rays through a scene: Embree finds the triangle in single precision, 16 rays at a time.
#pragma once

#include "render/triangle_planes.h"
#include "sim/scene.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace laterna {

/// 16 rays travel together: the pixels of a 4×4 tile, aligned to the image grid, row by row. Where the
/// machine has only 8 lanes, the tile's upper and lower halves travel one after the other.
inline constexpr int tile_edge = 4;
inline constexpr int packet_size = tile_edge * tile_edge;
inline constexpr std::uint32_t no_hit = 0xffffffffu;

/// x(t) = origin + t·direction, in world axes, relative to the scene's centre. Lanes with valid = 0 are left
/// out; others hold -1. All but `valid` stands as in Embree's RTCRayHit16, so that rays can be traced in
/// place; what first_hits() and occluded() set themselves may be left at 0.
struct alignas(64) RayPacket {
  float origin_x[packet_size], origin_y[packet_size], origin_z[packet_size], begin[packet_size];
  float direction_x[packet_size], direction_y[packet_size], direction_z[packet_size], time[packet_size];
  float end[packet_size];  ///< only hits with 0 < t < end count
  std::uint32_t mask[packet_size], id[packet_size], flags[packet_size];
  float normal_x[packet_size], normal_y[packet_size], normal_z[packet_size], u[packet_size], v[packet_size];
  std::uint32_t triangle[packet_size], object[packet_size], instance[packet_size];
  std::int32_t valid[packet_size];
};

/// A packet whose `begin`, `time`, `mask` and `flags` are those that every ray here has; the rest is 0.
RayPacket make_ray_packet();

/// What a packet met first.
struct alignas(64) HitPacket {
  float t[packet_size];
  std::uint32_t object[packet_size];  ///< index into Scene::objects, or no_hit
  std::uint32_t triangle[packet_size];
};

/// Counted in half-steps of single precision (2⁻²⁴ relative), how far above the surface a shadow ray starts.
/// Vertices and ray origin are each rounded by one at most in each coordinate (√3 each in space); the rest is
/// for Embree's own rounding, found by the acne test up to 85° incidence.
inline constexpr double shadow_margin_factor = 16;

/// A scene ready for rays. Geometry goes to Embree in single precision relative to the scene's centre (middle
/// of the bounding box), so that a scene far from the origin keeps its precision.
///
/// Embree's faster, not its robust, way is taken: a ray within a rounding error of an edge that two triangles
/// share may pass between them, one in a million of all rays and every fifth of those aimed at a vertex. What
/// gives such a ray away is that the 16 rays of a tile then disagree: some miss, or some see back sides, or
/// their depths do not follow a plane within 1e-3, or some are in shadow. Tiles like that are traced again up
/// to three times, each time turned by about 1e-6 (10⁻³ px), and the nearest hit, or any occluder, counts. So
/// the slip stays open only where two sheets are closer than 1e-3 of the depth, fronts alike.
///
/// A shadow ray starts margin_m above its triangle, along the normal on the lit side, and ends as far before
/// the projector: margin_m = 16·2⁻²⁴·(largest coordinate of the triangle relative to the scene's centre), 1
/// µm per metre. An occluder closer than 2·margin_m to the surface may be missed; one farther than that
/// throws its shadow.
class RayScene {
 public:
  /// Throws InputError as make_planes() does, and std::runtime_error with Embree's message where Embree
  /// fails. The scene must outlive this object only during the call.
  explicit RayScene(const Scene& scene);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  const glm::dvec3& center_world() const { return center_world_; }
  const std::vector<ObjectPlanes>& objects() const { return objects_; }
  const TrianglePlane& plane(std::uint32_t object, std::uint32_t triangle) const {
    return objects_[object].planes[triangle];
  }

  /// The first hit of each ray, on either side of a surface. Embree promises nothing at exactly 0 and `end`.
  /// `coherent` says that they run side by side as a tile of an image: faster where they do, and what the
  /// search for slipped rays relies on; without it there is none.
  void first_hits(const RayPacket& rays, HitPacket& hits, bool coherent = true) const;

  /// The same in place, for a packet of make_ray_packet(): `object` and `triangle`, and `end`, which becomes
  /// t where something is hit.
  void trace(RayPacket& rays, bool coherent = true) const;

  /// Whether anything stands between 0 and `end`: bit i of the result is lane i. The rays must be a tile's.
  std::uint32_t occluded(const RayPacket& rays) const;

  /// The same for a packet of make_ray_packet(), whose `end` is lost.
  std::uint32_t trace_shadows(RayPacket& rays) const;

  /// Calls closer(object, triangle) for every triangle that may be nearer to a point (relative to the
  /// scene's centre) than a radius: at first `radius_m`, then what the last call returned, and no larger
  /// one. The search is in single precision and keeps to the safe side: triangles farther off come too.
  void visit_near(const glm::dvec3& x_relative, double radius_m,
                  const std::function<double(std::uint32_t object, std::uint32_t triangle)>& closer) const;

 private:
  struct Embree;
  void close_gaps(RayPacket& rays, const float* end) const;
  std::unique_ptr<Embree> embree_;
  glm::dvec3 center_world_;
  std::vector<ObjectPlanes> objects_;
};

}  // namespace laterna
