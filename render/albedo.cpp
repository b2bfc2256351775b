#include "render/albedo.h"

#include <cmath>

namespace laterna {

namespace {

int wrap(int i, int size) {
  const int r = i % size;
  return r < 0 ? r + size : r;
}

double fraction(double x) { return x - std::floor(x); }

}  // namespace

double albedo_map_value(const Image<float>& map, const glm::dvec2& st) {
  const double u = fraction(st.x) * map.width - 0.5, v = (1 - fraction(st.y)) * map.height - 0.5;
  const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
  const double a = u - x, b = v - y;
  const auto at = [&](int i, int j) { return double(map(wrap(i, map.width), wrap(j, map.height))); };
  return (1 - b) * ((1 - a) * at(x, y) + a * at(x + 1, y)) +
         b * ((1 - a) * at(x, y + 1) + a * at(x + 1, y + 1));
}

glm::dvec2 texture_coordinates_at(const Mesh& mesh, std::uint32_t triangle, const glm::dvec3& x_object) {
  const glm::uvec3 t = mesh.triangles[triangle];
  const glm::dvec3 a = mesh.positions[t.x];
  const glm::dvec3 ab = mesh.positions[t.y] - a, ac = mesh.positions[t.z] - a, ap = x_object - a;
  const glm::dvec3 normal = glm::cross(ab, ac);
  const double area = glm::dot(normal, normal);
  if (!(area > 0)) return mesh.texture_coordinates[t.x];
  const double b = glm::dot(glm::cross(ap, ac), normal) / area,
               c = glm::dot(glm::cross(ab, ap), normal) / area;
  return (1 - b - c) * mesh.texture_coordinates[t.x] + b * mesh.texture_coordinates[t.y] +
         c * mesh.texture_coordinates[t.z];
}

}  // namespace laterna
