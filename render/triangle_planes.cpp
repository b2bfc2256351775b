#include "render/triangle_planes.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace laterna {

namespace {

double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

void check(const Object& object) {
  const std::size_t count = object.mesh.positions.size();
  for (const glm::dvec3& p : object.mesh.positions) {
    if (!std::isfinite(p.x + p.y + p.z))
      throw InputError(
          fmt::format("{}: a vertex is ({}, {}, {}), expected finite numbers", object.name, p.x, p.y, p.z));
  }
  for (const glm::uvec3& t : object.mesh.triangles) {
    if (std::max({t.x, t.y, t.z}) >= count) {
      throw InputError(fmt::format("{}: a triangle names vertex {}, expected one below {}", object.name,
                                   std::max({t.x, t.y, t.z}), count));
    }
  }
  const double det = glm::determinant(glm::dmat3(object.world_from_object));
  if (!std::isfinite(det) || det == 0) {
    throw InputError(fmt::format("{}: world_from_object is singular, expected a matrix that can be inverted",
                                 object.name));
  }
}

glm::dvec3 middle(const Mesh& mesh) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  glm::dvec3 low(infinity), high(-infinity);
  for (const glm::dvec3& p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
  return mesh.positions.empty() ? glm::dvec3(0.0) : 0.5 * (low + high);
}

}  // namespace

std::vector<glm::dvec3> world_positions(const Object& object) {
  std::vector<glm::dvec3> world;
  world.reserve(object.mesh.positions.size());
  for (const glm::dvec3& p : object.mesh.positions)
    world.emplace_back(object.world_from_object * glm::dvec4(p, 1.0));
  return world;
}

ObjectPlanes make_planes(const Object& object, const glm::dvec3& scene_center_world, double margin_factor) {
  check(object);
  const glm::dmat3 object_from_world = glm::inverse(glm::dmat3(object.world_from_object));
  const glm::dmat3 normal_matrix = glm::transpose(object_from_world);
  ObjectPlanes result{object.world_from_object, object_from_world, middle(object.mesh), {}};
  const std::vector<glm::dvec3> world = world_positions(object);
  result.planes.reserve(object.mesh.triangles.size());
  for (const glm::uvec3& t : object.mesh.triangles) {
    const glm::dvec3 a = object.mesh.positions[t.x] - result.center_object;
    const glm::dvec3 b = object.mesh.positions[t.y] - result.center_object;
    const glm::dvec3 c = object.mesh.positions[t.z] - result.center_object;
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    const double length = glm::length(cross);
    TrianglePlane plane{};
    if (length > 0) {
      plane.normal_object = cross / length;
      plane.distance = glm::dot(plane.normal_object, (a + b + c) / 3.0);
      plane.normal_world = glm::normalize(normal_matrix * plane.normal_object);
      const double reach =
          std::max({largest(world[t.x] - scene_center_world), largest(world[t.y] - scene_center_world),
                    largest(world[t.z] - scene_center_world)});
      plane.margin_m = margin_factor * std::ldexp(reach, -24);
    }
    result.planes.push_back(plane);
  }
  return result;
}

}  // namespace laterna
