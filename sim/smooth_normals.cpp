#include "sim/smooth_normals.h"

#include <array>
#include <cmath>
#include <map>
#include <tuple>

namespace laterna {

namespace {

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

std::vector<std::uint32_t> first_of_position(const Mesh& mesh) {
  std::map<std::tuple<double, double, double>, std::uint32_t> seen;
  std::vector<std::uint32_t> first;
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::dvec3& x = mesh.positions[i];
    first.push_back(seen.emplace(std::tuple(x.x, x.y, x.z), i).first->second);
  }
  return first;
}

glm::dvec3 unit_or_zero(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 1e-9 ? v / length : glm::dvec3(0.0);
}

std::vector<glm::dvec3> smooth_normals(const Mesh& mesh, const std::vector<std::uint32_t>& first) {
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
  for (const glm::uvec3& t : mesh.triangles) {
    const std::array<glm::dvec3, 3> x{mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
    const glm::dvec3 cross = glm::cross(x[1] - x[0], x[2] - x[0]);
    const double area = glm::length(cross);
    if (!(area > 0)) continue;
    for (int i = 0; i < 3; ++i)
      sums[first[t[i]]] += cross / area * angle_between(x[(i + 1) % 3] - x[i], x[(i + 2) % 3] - x[i]);
  }
  std::vector<glm::dvec3> normals;
  for (const std::uint32_t i : first) normals.push_back(unit_or_zero(sums[i]));
  return normals;
}

}  // namespace laterna
