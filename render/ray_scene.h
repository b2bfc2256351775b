// Rays through a scene: Embree finds the triangle in single precision, 16 rays at a time.
#pragma once

#include "render/triangle_planes.h"
#include "sim/scene.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace laterna {

/// 16 rays travel together: the pixels of a 4×4 tile, aligned to the image grid, row by row. Where the
/// machine has only 8 lanes, the tile's upper and lower halves travel one after the other.
inline constexpr int tile_edge = 4;
inline constexpr int packet_size = tile_edge * tile_edge;
inline constexpr std::uint32_t no_hit = 0xffffffffu;

/// x(t) = origin + t·direction, in world axes, relative to the scene's centre. Lanes with valid = 0 are left
/// out; others hold -1.
struct alignas(64) RayPacket {
  float origin_x[packet_size], origin_y[packet_size], origin_z[packet_size];
  float direction_x[packet_size], direction_y[packet_size], direction_z[packet_size];
  float end[packet_size];  ///< only hits with 0 < t < end count
  std::int32_t valid[packet_size];
};

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
  /// `coherent` only tells Embree that the rays run side by side, which is faster where they do.
  void first_hits(const RayPacket& rays, HitPacket& hits, bool coherent = true) const;

  /// Whether anything stands between 0 and `end`: bit i of the result is lane i.
  std::uint32_t occluded(const RayPacket& rays) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
  glm::dvec3 center_world_;
  std::vector<ObjectPlanes> objects_;
};

}  // namespace laterna
