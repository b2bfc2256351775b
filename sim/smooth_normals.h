// Normals of vertices.
#pragma once

#include "sim/mesh.h"

#include <cstdint>
#include <vector>

namespace laterna {

/// For each vertex, the first one of exactly its position: across a seam of the texture, vertices differ but
/// positions do not.
std::vector<std::uint32_t> first_of_position(const Mesh& mesh);

/// v/|v|; 0 where |v| is at most 1e-9: unit vectors that cancel out, to rounding.
glm::dvec3 unit_or_zero(const glm::dvec3& v);

/// The unit normal of each vertex, towards the front: of all triangles around its position, weighted by their
/// angles there (Thürmer and Wüthrich, Journal of Graphics Tools 3(1), 1998). 0 where they cancel out, or
/// where no triangle of some area has the vertex. `first`: first_of_position().
std::vector<glm::dvec3> smooth_normals(const Mesh& mesh, const std::vector<std::uint32_t>& first);

}  // namespace laterna
