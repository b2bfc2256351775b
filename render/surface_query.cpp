#include "render/surface_query.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace laterna {

namespace {

double distance_to_segment(const glm::dvec3& x, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 along = b - a;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0 ? std::clamp(glm::dot(x - a, along) / length2, 0.0, 1.0) : 0.0;
  return glm::distance(x, a + t * along);
}

// Rays that all start at one point.
RayPacket packet_from(const glm::dvec3& origin, std::span<const glm::dvec3> directions) {
  RayPacket rays = make_ray_packet();
  for (std::size_t i = 0; i < packet_size; ++i) {
    const glm::dvec3 d = i < directions.size() ? directions[i] : glm::dvec3(0.0);
    rays.valid[i] = std::isfinite(d.x + d.y + d.z) && glm::dot(d, d) > 0 ? -1 : 0;
    if (!rays.valid[i]) continue;
    rays.origin_x[i] = float(origin.x), rays.origin_y[i] = float(origin.y),
    rays.origin_z[i] = float(origin.z);
    rays.direction_x[i] = float(d.x), rays.direction_y[i] = float(d.y), rays.direction_z[i] = float(d.z);
    rays.end[i] = std::numeric_limits<float>::infinity();
  }
  return rays;
}

constexpr double beyond_float_m = 1e30;  // squares of it are no numbers of single precision
constexpr double largest_move = 1e-3;    // of the distance, from Embree's point to the plane's

}  // namespace

double distance_to_triangle(const glm::dvec3& x, const glm::dvec3& a, const glm::dvec3& b,
                            const glm::dvec3& c) {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const auto is_inside = [&](const glm::dvec3& from, const glm::dvec3& to) {
    return glm::dot(glm::cross(normal, to - from), x - from) >= 0;
  };
  const double length = glm::length(normal);
  if (length > 0 && is_inside(a, b) && is_inside(b, c) && is_inside(c, a))
    return std::abs(glm::dot(normal, x - a)) / length;
  return std::min({distance_to_segment(x, a, b), distance_to_segment(x, b, c), distance_to_segment(x, c, a)});
}

SurfaceQuery::SurfaceQuery(const RayScene& rays, const Scene& scene) : rays_(rays), scene_(scene) {
  for (const Object& object : scene.objects) {
    vertices_.push_back(world_positions(object));
    for (glm::dvec3& x : vertices_.back()) x -= rays.center_world();
  }
}

double SurfaceQuery::distance_m(const glm::dvec3& x_world, double most_m) const {
  const glm::dvec3 x = x_world - rays_.center_world();
  if (!(glm::length(x) < beyond_float_m)) return most_m;
  double least = most_m;
  rays_.visit_near(x, most_m, [&](std::uint32_t object, std::uint32_t triangle) {
    const glm::uvec3& t = scene_.objects[object].mesh.triangles[triangle];
    const std::vector<glm::dvec3>& v = vertices_[object];
    return least = std::min(least, distance_to_triangle(x, v[t.x], v[t.y], v[t.z]));
  });
  return least;
}

glm::dvec3 SurfaceQuery::on_plane(const RayPacket& rays, int lane, const glm::dvec3& origin,
                                  const glm::dvec3& direction) const {
  const std::uint32_t object = rays.object[lane];
  const glm::uvec3& t = scene_.objects[object].mesh.triangles[rays.triangle[lane]];
  const std::vector<glm::dvec3>& v = vertices_[object];
  const glm::dvec3 normal = glm::cross(v[t.y] - v[t.x], v[t.z] - v[t.x]);
  const double found = double(rays.end[lane]);
  const double exact = glm::dot(normal, v[t.x] - origin) / glm::dot(normal, direction);
  return origin + (std::abs(exact - found) <= largest_move * found ? exact : found) * direction;
}

std::vector<glm::dvec3> SurfaceQuery::first_points(const glm::dvec3& origin_world,
                                                   std::span<const glm::dvec3> directions) const {
  const glm::dvec3 center = rays_.center_world(), origin = origin_world - center;
  std::vector<glm::dvec3> points(directions.size(), glm::dvec3(std::numeric_limits<double>::quiet_NaN()));
  for (std::size_t first = 0; first < directions.size(); first += packet_size) {
    RayPacket rays = packet_from(origin, directions.subspan(first));
    rays_.trace(rays, false);
    for (int i = 0; i < packet_size; ++i)
      if (rays.valid[i] && rays.object[i] != no_hit)
        points[first + std::size_t(i)] =
            center + on_plane(rays, i, origin, directions[first + std::size_t(i)]);
  }
  return points;
}

}  // namespace laterna
