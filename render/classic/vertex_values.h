// What stands at a mesh's vertices, between them: the interpolation of a rasteriser, perspective-correct.
#pragma once

#include "render/surface.h"
#include "sim/mesh.h"

#include <glm/glm.hpp>

#include <vector>

namespace laterna {

/// The shares of a triangle's three vertices at a point of its plane: x = Σ share·vertex, Σ share = 1. The
/// triangle must not be degenerate.
inline glm::dvec3 vertex_shares(const Mesh& mesh, std::uint32_t triangle, const glm::dvec3& x_object) {
  const glm::uvec3 corner = mesh.triangles[triangle];
  const glm::dvec3 a = mesh.positions[corner.x], b = mesh.positions[corner.y], c = mesh.positions[corner.z];
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double whole = glm::dot(normal, normal);
  const double share_b = glm::dot(glm::cross(x_object - a, c - a), normal) / whole;
  const double share_c = glm::dot(glm::cross(b - a, x_object - a), normal) / whole;
  return {1 - share_b - share_c, share_b, share_c};
}

/// The value at pixel p of a surface that sees `mesh`, of one value per vertex.
template <class T>
T vertex_value(const Mesh& mesh, const std::vector<T>& of_vertex, const SurfaceMap& surface, std::size_t p) {
  const std::uint32_t triangle = surface.triangle.values[p];
  const glm::dvec3 share = vertex_shares(mesh, triangle, surface.point_object.values[p]);
  const glm::uvec3 corner = mesh.triangles[triangle];
  return of_vertex[corner.x] * share.x + of_vertex[corner.y] * share.y + of_vertex[corner.z] * share.z;
}

}  // namespace laterna
