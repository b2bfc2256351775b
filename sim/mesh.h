// Triangle meshes in double precision.
#pragma once

#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace laterna {

/// Triangles over shared vertices, in the object's frame. A triangle's front is the side from which its
/// vertices turn counter-clockwise. `texture_coordinates` (s right, t up, [0,1] across the picture) is empty
/// or has one per vertex.
struct Mesh {
  std::vector<glm::dvec3> positions;
  std::vector<glm::uvec3> triangles;
  std::vector<glm::dvec2> texture_coordinates;
};

/// What validate() counted.
struct MeshReport {
  std::size_t degenerate_triangles = 0;  ///< triangles of zero area; harmless, no ray hits them
};

/// Throws InputError, beginning with `what` (the file), where the mesh has no vertices, no triangles, a
/// coordinate that is not finite, an index out of range, texture coordinates of another count than vertices,
/// or only degenerate triangles.
MeshReport validate(const Mesh& mesh, const std::string& what);

/// Corners of the smallest box, parallel to the axes, around the vertices that triangles use.
struct Box {
  glm::dvec3 low, high;
};
Box bounds(const Mesh& mesh);

}  // namespace laterna
