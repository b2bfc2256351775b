#include "render/effects/normal_map.h"

#include "render/albedo.h"

#include <cmath>

namespace laterna {

namespace {

int wrap(int i, int size) { return (i % size + size) % size; }

glm::dvec3 map_value(const Image<glm::vec3>& map, const glm::dvec2& st) {
  const double u = (st.x - std::floor(st.x)) * map.width - 0.5;
  const double v = (1 - (st.y - std::floor(st.y))) * map.height - 0.5;
  const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
  const auto at = [&](int i, int j) { return glm::dvec3(map(wrap(i, map.width), wrap(j, map.height))); };
  return glm::mix(glm::mix(at(x, y), at(x + 1, y), u - x), glm::mix(at(x, y + 1), at(x + 1, y + 1), u - x),
                  v - y);
}

// Columns ∂x/∂s and ∂x/∂t of the triangle, in the world; not finite where its texture coordinates have no
// area.
struct Tangents {
  glm::dvec3 along_s, along_t;
};

Tangents tangents_of(const Object& object, std::uint32_t triangle) {
  const glm::uvec3 t = object.mesh.triangles[triangle];
  const auto& x = object.mesh.positions;
  const auto& st = object.mesh.texture_coordinates;
  const glm::dvec3 a = x[t.y] - x[t.x], b = x[t.z] - x[t.x];
  const glm::dvec2 p = st[t.y] - st[t.x], q = st[t.z] - st[t.x];
  const double area = p.x * q.y - p.y * q.x;
  const glm::dmat3 world_from_object(object.world_from_object);
  return {world_from_object * (q.y * a - p.y * b) / area, world_from_object * (p.x * b - q.x * a) / area};
}

}  // namespace

glm::dvec3 mapped_normal(const Object& object, std::uint32_t triangle, const glm::dvec3& x_object,
                         const glm::dvec3& normal_world) {
  const Tangents along = tangents_of(object, triangle);
  const double length = glm::length(along.along_s);
  if (!(length > 0) || !std::isfinite(length)) return normal_world;
  const glm::dvec3 t = along.along_s / length;
  glm::dvec3 b = glm::cross(normal_world, t);
  if (glm::dot(b, along.along_t) < 0) b = -b;
  const glm::dvec2 st = texture_coordinates_at(object.mesh, triangle, x_object);
  const glm::dvec3 n = 2.0 * map_value(*object.normal_map, st) - 1.0;
  return glm::normalize(n.x * t + n.y * b + n.z * normal_world);
}

void apply_normal_map(LightMap& light, const PixelGeometry& geometry, const Projector& projector) {
  const glm::dvec3 center = geometry.center(projector.device);
  weigh(light, [&](std::size_t p) {
    if (!geometry.object(p).normal_map) return 1.0;
    const glm::dvec3 towards = center - geometry.point(p);
    const double flat = glm::dot(geometry.flat_normal(p), towards);
    // On the back side (back_face off) the relief is seen from behind: both dot products change sign.
    return std::max(0.0, glm::dot(geometry.normal(p), towards) / flat);
  });
}

}  // namespace laterna
