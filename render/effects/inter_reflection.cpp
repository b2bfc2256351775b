#include "render/effects/inter_reflection.h"

#include "render/albedo.h"
#include "render/effects/pixel_geometry.h"
#include "render/effects/solid_albedo.h"
#include "render/pixel_samples.h"

#include <Random123/threefry.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace laterna {

namespace {

// In world axes, relative to the scene's centre.
struct PathRay {
  glm::dvec3 origin, direction;
};

// One tile of paths on their way.
struct Tile {
  RayPacket packet{};
  HitPacket hits;
  PathRay rays[packet_size];
};

// From pixel p's point into the side that it was reached from. False: below the horizon of the flat triangle,
// which a mapped normal allows.
bool leave(const PixelGeometry& geometry, const RayScene& scene, std::size_t p, const glm::dvec2& numbers,
           PathRay& ray) {
  const SurfaceMap& at = geometry.surface();
  const double side = at.seen_front.values[p] ? 1 : -1;
  const glm::dvec3 flat = side * geometry.flat_normal(p);
  const double margin = scene.plane(at.object.values[p], at.triangle.values[p]).margin_m;
  ray = {geometry.point(p) + margin * flat, cosine_direction(side * geometry.normal(p), numbers)};
  return glm::dot(flat, ray.direction) > 0;
}

void put(RayPacket& packet, int lane, const PathRay& ray) {
  packet.origin_x[lane] = float(ray.origin.x), packet.direction_x[lane] = float(ray.direction.x);
  packet.origin_y[lane] = float(ray.origin.y), packet.direction_y[lane] = float(ray.direction.y);
  packet.origin_z[lane] = float(ray.origin.z), packet.direction_z[lane] = float(ray.direction.z);
  packet.valid[lane] = -1;
}

void end_path(SurfaceMap& paths, std::size_t p) {
  paths.object.values[p] = paths.triangle.values[p] = no_hit;
  paths.albedo.values[p] = 0;
}

double albedo_at(const Object& object, std::uint32_t triangle, const glm::dvec3& point_object) {
  if (!object.albedo_map || object.mesh.texture_coordinates.empty()) return object.albedo;
  const glm::dvec2 st = texture_coordinates_at(object.mesh, triangle, point_object);
  return object.albedo * albedo_map_value(*object.albedo_map, st);
}

void arrive(const RayScene& rays, const Scene& scene, const PathRay& ray, std::uint32_t id,
            std::uint32_t triangle, double embree_t, SurfaceMap& paths, std::size_t p) {
  const Object& object = scene.objects[id];
  const ObjectPlanes& planes = rays.objects()[id];
  const TrianglePlane& plane = planes.planes[triangle];
  const glm::dvec3 object_relative = glm::dvec3(object.world_from_object[3]) - rays.center_world();
  const glm::dvec3 origin = planes.object_from_world_linear * (ray.origin - object_relative);
  const glm::dvec3 direction = planes.object_from_world_linear * ray.direction;
  const double slope = glm::dot(plane.normal_object, direction);
  double t = (plane.distance - glm::dot(plane.normal_object, origin - planes.center_object)) / slope;
  if (!(std::abs(t - embree_t) <= 1e-3 * embree_t)) t = embree_t;
  const bool front = slope < 0;
  paths.object.values[p] = id, paths.triangle.values[p] = triangle;
  paths.point_object.values[p] = origin + t * direction;
  paths.depth_m.values[p] = t;
  paths.seen_front.values[p] = front;
  if (front || !scene.effects.back_face)
    paths.albedo.values[p] *= float(albedo_at(object, triangle, paths.point_object.values[p]));
  else
    end_path(paths, p);
}

}  // namespace

glm::dvec2 path_numbers(const PathStep& step, const glm::ivec2& pixel) {
  using Threefry = r123::Threefry4x32;
  const Threefry::key_type key{{std::uint32_t(step.seed), std::uint32_t(step.seed >> 32), step.camera, 0}};
  const Threefry::ctr_type counter{{std::uint32_t(pixel.x) | std::uint32_t(pixel.y) << 16,
                                    std::uint32_t(step.sample), std::uint32_t(step.path),
                                    std::uint32_t(step.bounce)}};
  const Threefry::ctr_type bits = Threefry()(counter, key);
  const glm::dvec2 inside = (glm::dvec2(bits[0], bits[1]) + 0.5) * 0x1p-32;
  if (step.bounce > 0) return inside;
  const glm::ivec2 count = cells(step.paths);
  return (glm::dvec2(step.path % count.x, step.path / count.x) + inside) / glm::dvec2(count);
}

// The frame about the normal after Duff et al., "Building an orthonormal basis, revisited", 2017.
glm::dvec3 cosine_direction(const glm::dvec3& n, const glm::dvec2& numbers) {
  const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  const glm::dvec3 tangent(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
  const glm::dvec3 bitangent(b, sign + n.y * n.y * a, -n.y);
  const double sine = std::sqrt(numbers.x), azimuth = 2 * std::numbers::pi * numbers.y;
  return sine * std::cos(azimuth) * tangent + sine * std::sin(azimuth) * bitangent +
         std::sqrt(1 - numbers.x) * n;
}

void follow_paths(const RayScene& rays, const Scene& scene, const PathStep& step, SurfaceMap& paths) {
  const PixelGeometry geometry(paths, rays, scene);
  Tile tile;
  std::fill_n(tile.packet.end, packet_size, std::numeric_limits<float>::infinity());
  const auto each_lane = [&](int x0, int y0, const auto& work) {
    for (int y = y0; y < std::min(y0 + tile_edge, paths.height); ++y)
      for (int x = x0; x < std::min(x0 + tile_edge, paths.width); ++x)
        work((y - y0) * tile_edge + x - x0, paths.object.index(x, y), paths.first_px + glm::ivec2(x, y));
  };
  for (int y0 = 0; y0 < paths.height; y0 += tile_edge) {
    for (int x0 = 0; x0 < paths.width; x0 += tile_edge) {
      std::fill_n(tile.packet.valid, packet_size, 0);
      each_lane(x0, y0, [&](int lane, std::size_t p, const glm::ivec2& pixel) {
        if (!paths.hit(p) || !(paths.albedo.values[p] > 0)) return;
        if (leave(geometry, rays, p, path_numbers(step, pixel), tile.rays[lane]))
          put(tile.packet, lane, tile.rays[lane]);
      });
      rays.first_hits(tile.packet, tile.hits, false);
      each_lane(x0, y0, [&](int lane, std::size_t p, const glm::ivec2&) {
        const std::uint32_t id = tile.packet.valid[lane] ? tile.hits.object[lane] : no_hit;
        if (id == no_hit)
          end_path(paths, p);
        else
          arrive(rays, scene, tile.rays[lane], id, tile.hits.triangle[lane], tile.hits.t[lane], paths, p);
      });
    }
  }
  if (scene.effects.solid_albedo) apply_solid_albedo(paths, scene);
}

}  // namespace laterna
