#include "sim/decimate.h"

#include "sim/smooth_normals.h"

#include <meshoptimizer.h>
#include <glm/gtc/type_ptr.hpp>
#include <limits>

namespace laterna {

namespace {

constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();

// The mesh with the vertices that its triangles use, in their order.
Mesh compacted(const std::vector<glm::dvec3>& positions, std::vector<glm::uvec3> triangles) {
  std::vector<std::uint32_t> place(positions.size(), unused);
  for (const glm::uvec3& t : triangles) place[t.x] = place[t.y] = place[t.z] = 0;
  Mesh mesh;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (place[i] == unused) continue;
    place[i] = std::uint32_t(mesh.positions.size());
    mesh.positions.push_back(positions[i]);
  }
  for (glm::uvec3& t : triangles) t = {place[t.x], place[t.y], place[t.z]};
  mesh.triangles = std::move(triangles);
  return mesh;
}

}  // namespace

Mesh welded(const Mesh& mesh) {
  const std::vector<std::uint32_t> first = first_of_position(mesh);
  std::vector<glm::uvec3> triangles = mesh.triangles;
  for (glm::uvec3& t : triangles) t = {first[t.x], first[t.y], first[t.z]};
  return compacted(mesh.positions, std::move(triangles));
}

Mesh decimated(const Mesh& mesh, double keep) {
  const Box box = bounds(mesh);
  const glm::dvec3 center = 0.5 * (box.low + box.high);
  std::vector<glm::vec3> near_origin;  // floats lose nothing that matters there
  near_origin.reserve(mesh.positions.size());
  for (const glm::dvec3& x : mesh.positions) near_origin.emplace_back(x - center);
  std::vector<unsigned> indices, kept(3 * mesh.triangles.size());
  indices.reserve(kept.size());
  for (const glm::uvec3& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) indices.push_back(t[i]);
  constexpr float any_error = 1e10f;  // the count decides
  const std::size_t wanted = 3 * std::size_t(keep * double(mesh.triangles.size()));
  kept.resize(meshopt_simplify(kept.data(), indices.data(), indices.size(), glm::value_ptr(near_origin[0]),
                               near_origin.size(), sizeof(glm::vec3), wanted, any_error, 0, nullptr));
  if (kept.empty()) return mesh;
  std::vector<glm::uvec3> triangles;
  for (std::size_t i = 0; i < kept.size(); i += 3) triangles.emplace_back(kept[i], kept[i + 1], kept[i + 2]);
  return compacted(mesh.positions, std::move(triangles));
}

}  // namespace laterna
