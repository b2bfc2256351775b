// Where triangles meet, and where they do so without sharing an edge.
#pragma once

#include "render/surface.h"
#include "sim/image.h"

namespace laterna::gl {

/// OpenGL's rasteriser moves vertices to multiples of 1/256 px (Mesa's count of subpixel bits: 8). Triangles
/// that share two vertices still meet; an edge that ends on another edge's middle may open by as much.
inline constexpr double vertex_snap_px = 1.0 / 256;

/// 2 at pixels whose centre is within 2·vertex_snap_px of an open edge of the triangle that they see: one
/// whose two end points, by their coordinates, no other triangle of the mesh has. 1 within that of another of
/// its edges; else 0.
Image<std::uint8_t> near_sides(const Scene& scene, const SurfaceMap& surface);

}  // namespace laterna::gl
