// The hot arithmetic of visibility, over the 16 pixels of a 4×4 tile. Each is compiled for several
// instruction sets, with the same bits from all.
//
// Lanes that see nothing, or another object, take part: what comes out of them means nothing.
#pragma once

#include "render/projective_lookup.h"
#include "render/ray_scene.h"

#include <cstdint>

namespace laterna {

/// Whether a traced tile (render/ray_scene.h) looks as if a ray had slipped between two triangles: of the
/// valid rays some hit and some miss, or some miss and the tile is not full; some see front sides and some
/// see back sides; or three depths in a row or column are off a line by more than 1e-3 of the depth.
bool rays_disagree(const RayPacket& rays);

/// Bit i: lane i is valid and has a negative `end`, Embree's word for an occluded ray.
std::uint32_t blocked_lanes(const RayPacket& rays);

using TileDoubles = double[packet_size];
using TileFloats = float[packet_size];  // to be aligned to 64 bytes, as all arrays of a tile

/// The rays of a tile: x/z and y/z in the camera's frame, NaN where there is none.
struct alignas(64) TileRays {
  TileDoubles x, y;
  TileDoubles start_x_m,
      start_y_m;           ///< where they start, in the camera's plane z = 0; read where `from_lens`
  bool from_lens = false;  ///< whether they start beside the camera's centre
};

/// The planes that a tile's rays meet: normal·(x - center_object) = distance in the object's frame.
struct alignas(64) TilePlanes {
  TileDoubles normal_x, normal_y, normal_z, distance;
};

/// Where they meet them.
struct alignas(64) TileSurface {
  TileDoubles depth_m, x, y, z;  ///< along the optical axis; in the object's frame, metres
  TileDoubles slope;             ///< normal·ray: negative where the front side is seen
};

/// Writes the directions of `rays` in world axes, valid where there is a direction. `world_from_device`: by
/// columns.
void aim_tile(const glm::dmat3& world_from_device, const TileRays& directions, RayPacket& rays);

/// depth = (distance - normal·camera_from_center)/slope, or Embree's where that differs by more than 1e-3 of
/// it; point = camera_object + depth·object_from_device·(x, y, 1), where rays that start beside the camera's
/// centre add their start to both places of the camera.
void refine_tile(const glm::dmat3& object_from_device, const glm::dvec3& camera_from_center,
                 const glm::dvec3& camera_object, const TileRays& directions, const TilePlanes& planes,
                 const TileFloats& embree_depth, TileSurface& surface);

/// Points of one object, with the planes under them.
struct alignas(64) TilePoints {
  TileDoubles x, y, z;                       ///< in the object's frame, metres
  TileDoubles normal_x, normal_y, normal_z;  ///< in the world
  TileDoubles margin_m;                      ///< of the shadow ray
  TileDoubles front;                         ///< 1 where the camera sees the front side, else 0
};

/// Where they fall in the projector's picture. `u_px`, `v_px`: NaN where q ≤ 0.
struct alignas(64) TilePixels {
  TileDoubles u_px, v_px, q;
  TileDoubles pixels_per_unit_area;
};

/// (u, v, q) of each point, and the pinhole's area, without lens.
void project_tile(const LookupTerms& lookup, const TilePoints& points, TilePixels& pixels);

/// What one object needs to be lit.
struct LightTerms {
  LookupTerms lookup;
  glm::dmat3 world_from_object_linear;
  glm::dvec3 object_relative;  ///< the object's origin, in world axes, relative to the scene's centre
  glm::dvec3 center_relative;  ///< the projector's centre, likewise
  double flux_per_pixel_lm, facing_at_1_m_lx;
  bool back_face, irradiance, shadow;  ///< switches of Effects
};

/// White light of each point, why it is dark (Unlit, but for shadows), and its shadow ray, valid where it is
/// lit and shadows are on. See trace_light().
struct alignas(64) TileLight {
  TileDoubles white_lx;
  std::int32_t why[packet_size];
};
void light_tile(const LightTerms& terms, const TilePoints& points, const TilePixels& pixels, TileLight& light,
                RayPacket& shadow_rays);

}  // namespace laterna
