#include "sim/mesh.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace laterna {

namespace {

template <class Vector>
void expect_finite(const std::vector<Vector>& vectors, const std::string& what, const char* coordinates) {
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    for (int axis = 0; axis < Vector::length(); ++axis) {
      if (std::isfinite(vectors[i][axis])) continue;
      throw InputError(fmt::format("{}: vertex {} holds {}, expected finite {}", what, i,
                                   std::isnan(vectors[i][axis]) ? "nan" : "an infinity", coordinates));
    }
  }
}

void expect_indices_in_range(const Mesh& mesh, const std::string& what) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::size_t index = mesh.triangles[i][corner];
      if (index < mesh.positions.size()) continue;
      throw InputError(fmt::format("{}: triangle {} uses vertex {}, expected 0 to {}", what, i, index,
                                   mesh.positions.size() - 1));
    }
  }
}

bool is_degenerate(const Mesh& mesh, const glm::uvec3& triangle) {
  const glm::dvec3& a = mesh.positions[triangle[0]];
  return glm::cross(mesh.positions[triangle[1]] - a, mesh.positions[triangle[2]] - a) == glm::dvec3(0.0);
}

}  // namespace

MeshReport validate(const Mesh& mesh, const std::string& what) {
  if (mesh.positions.empty()) throw InputError(what + ": the mesh has no vertices, expected at least three");
  if (mesh.triangles.empty()) throw InputError(what + ": the mesh has no triangles, expected at least one");
  if (!mesh.texture_coordinates.empty() && mesh.texture_coordinates.size() != mesh.positions.size()) {
    throw InputError(fmt::format("{}: {} texture coordinates for {} vertices, expected one each or none",
                                 what, mesh.texture_coordinates.size(), mesh.positions.size()));
  }
  expect_finite(mesh.positions, what, "coordinates");
  expect_finite(mesh.texture_coordinates, what, "texture coordinates");
  expect_indices_in_range(mesh, what);
  MeshReport report;
  for (const glm::uvec3& triangle : mesh.triangles)
    report.degenerate_triangles += is_degenerate(mesh, triangle);
  if (report.degenerate_triangles == mesh.triangles.size()) {
    throw InputError(fmt::format("{}: each of its {} triangles has zero area, expected a surface", what,
                                 mesh.triangles.size()));
  }
  return report;
}

Box bounds(const Mesh& mesh) {
  const double infinity = std::numeric_limits<double>::infinity();
  Box box{glm::dvec3(infinity), glm::dvec3(-infinity)};
  for (const glm::uvec3& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      box.low = glm::min(box.low, mesh.positions[triangle[corner]]);
      box.high = glm::max(box.high, mesh.positions[triangle[corner]]);
    }
  }
  return box;
}

}  // namespace laterna
