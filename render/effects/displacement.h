// Displacement map. Stage: surface.
//
//   x' = x + displacement·h(s, t)·n,
//
// x a point of the mesh, n its smooth normal, h the map's value from 0 to 1, bilinear and repeated: black
// stays, white moves by `displacement` along the normal, or against it where that is below 0. All in the
// mesh's own frame and unit, before world_from_object. The geometry itself moves: silhouettes, shadows, depth
// and normals are those of the displaced surface, where a normal map only shades.
//
// Smooth normals are those of the given mesh: of all triangles around a position, weighted by their angles
// there (Thürmer and Wüthrich, Journal of Graphics Tools 3(1), 1998), also across seams of the texture, where
// vertices of exactly equal position have different texture coordinates. Where they cancel out, the vertex
// stays.
//
// First every edge longer than `displacement_edge_px` pixels of the map is halved, until none is; new
// vertices have interpolated texture coordinates and normals. Triangles that share an edge, also across a
// seam, agree on it: a closed mesh stays closed, but where the two sides of a seam show different values of
// the map.
#pragma once

#include "sim/scene.h"

#include <optional>

namespace laterna {

/// More triangles than this are refused.
inline constexpr std::size_t most_displaced_triangles = std::size_t{1} << 22;

/// The object with its mesh displaced. It must have a displacement map and texture coordinates. Throws
/// InputError, naming the object, where its mesh would come to have more than most_displaced_triangles.
Object displaced(const Object& object);

/// The scene as rays meet it: `scene` itself where the effect is off or no object has a map; else a copy in
/// `storage`, whose effect is off, since its meshes are displaced already.
const Scene& displaced(const Scene& scene, std::optional<Scene>& storage);

}  // namespace laterna
