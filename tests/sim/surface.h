// Laws of closed surfaces, for the tests of meshes.
#pragma once

#include "sim/mesh.h"

#include <array>
#include <map>
#include <utility>

namespace laterna::testing {

using Position = std::array<double, 3>;

inline Position position_of(const Mesh& mesh, unsigned vertex) {
  const glm::dvec3& p = mesh.positions[vertex];
  return {p.x + 0.0, p.y + 0.0, p.z + 0.0};  // -0 and 0 are the same place
}

/// How many directed edges lack their one opposite: 0 for a closed surface whose triangles turn alike.
/// Vertices of exactly equal positions count as one.
inline int open_edges(const Mesh& mesh) {
  std::map<std::pair<Position, Position>, int> count;
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++count[{position_of(mesh, t[k]), position_of(mesh, t[(k + 1) % 3])}];
  int open = 0;
  for (const auto& [edge, times] : count) {
    const auto opposite = count.find({edge.second, edge.first});
    if (times != 1 || opposite == count.end() || opposite->second != 1) ++open;
  }
  return open;
}

/// The enclosed volume (divergence theorem), positive where fronts are outside.
inline double volume(const Mesh& mesh) {
  double six_volumes = 0;
  for (const glm::uvec3& t : mesh.triangles)
    six_volumes += glm::dot(mesh.positions[t[0]], glm::cross(mesh.positions[t[1]], mesh.positions[t[2]]));
  return six_volumes / 6;
}

/// Twice the area of a triangle times its front's normal.
inline glm::dvec3 area_vector(const Mesh& mesh, const glm::uvec3& t) {
  return glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
}

/// Whether each triangle's picture is upright from the front, not mirrored: its corners turn alike in (s, t).
inline bool pictures_unmirrored(const Mesh& mesh) {
  for (const glm::uvec3& t : mesh.triangles) {
    const auto& st = mesh.texture_coordinates;
    const glm::dvec2 a = st[t[1]] - st[t[0]], b = st[t[2]] - st[t[0]];
    if (a.x * b.y - a.y * b.x <= 0) return false;
  }
  return true;
}

}  // namespace laterna::testing
