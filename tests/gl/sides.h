// Where triangles meet, and where they do so without sharing an edge.
#pragma once

#include "render/surface.h"
#include "sim/image.h"

namespace laterna::gl {

/// A rasteriser moves vertices to multiples of a small part of a pixel: Mesa's to 1/256 px. Triangles
/// that share two vertices still meet; an edge that ends on another edge's middle may open by as much.
inline constexpr double mesa_snap_px = 1.0 / 256;

/// 2 at pixels whose centre is within 2·snap_px of an open edge of the triangle that they see: one
/// whose two end points, by their coordinates, no other triangle of the mesh has. 1 within that of another of
/// its edges; else 0.
Image<std::uint8_t> near_sides(const Scene& scene, const SurfaceMap& surface, double snap_px);

}  // namespace laterna::gl
