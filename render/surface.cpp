#include "render/surface.h"

#include "render/albedo.h"
#include "sim/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace laterna {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// One tile of a camera's image while it is traced.
struct Tile {
  RayPacket rays;
  HitPacket hits;
  glm::dvec2 direction[packet_size];  // x/z, y/z in the camera's frame
  const LensPoints* lens;             // null: rays start at the camera's centre
  glm::dvec2 start_m[packet_size];    // with a lens: x, y in the camera's frame
  int count_x, count_y;               // pixels inside the image
};

// `first`: the place of the tile's first pixel among the lens's points, in rows of `stride`.
void start_on_lens(Tile& tile, const CameraView& view, std::size_t first, int stride) {
  for (int lane = 0; lane < packet_size; ++lane) {
    const int i = lane % tile_edge, j = lane / tile_edge;
    const bool inside = i < tile.count_x && j < tile.count_y;
    const glm::dvec2 at = inside ? glm::dvec2(tile.lens->points_m[first + j * stride + i]) : glm::dvec2(0.0);
    const glm::dvec3 start = view.camera_relative + view.world_from_device * glm::dvec3(at, 0.0);
    tile.start_m[lane] = at;
    tile.rays.origin_x[lane] = static_cast<float>(start.x);
    tile.rays.origin_y[lane] = static_cast<float>(start.y);
    tile.rays.origin_z[lane] = static_cast<float>(start.z);
  }
}

// `offsets_px`: null, or that of the tile's first pixel, in rows of `stride`.
void aim(Tile& tile, const CameraView& view, const CameraRays& directions, const glm::ivec2& first_px,
         const glm::vec2* offsets_px, int stride) {
  for (int lane = 0; lane < packet_size; ++lane) {
    const int i = lane % tile_edge, j = lane / tile_edge, x = first_px.x + i, y = first_px.y + j;
    glm::dvec2 d(nan);
    if (i < tile.count_x && j < tile.count_y)
      d = offsets_px ? directions.direction(x, y, offsets_px[j * stride + i]) : directions.direction(x, y);
    if (tile.lens) d -= tile.start_m[lane] / tile.lens->focus_m;
    const glm::dmat3& m = view.world_from_device;
    tile.direction[lane] = d;
    tile.rays.valid[lane] = d.x == d.x ? -1 : 0;
    tile.rays.direction_x[lane] = static_cast<float>(m[0].x * d.x + m[1].x * d.y + m[2].x);
    tile.rays.direction_y[lane] = static_cast<float>(m[0].y * d.x + m[1].y * d.y + m[2].y);
    tile.rays.direction_z[lane] = static_cast<float>(m[0].z * d.x + m[1].z * d.y + m[2].z);
  }
}

void write_miss(SurfaceMap& map, std::size_t p) {
  map.object.values[p] = map.triangle.values[p] = no_hit;
  map.point_object.values[p] = glm::dvec3(nan);
  map.depth_m.values[p] = nan;
  map.albedo.values[p] = 0;
  map.seen_front.values[p] = 0;
}

void write_hit(SurfaceMap& map, std::size_t p, const ObjectView& object, const TrianglePlane& plane,
               const glm::dvec2& d, const glm::dvec2* start_m, double embree_depth) {
  const glm::dvec3 beside_object =
      start_m ? object.object_from_device * glm::dvec3(*start_m, 0.0) : glm::dvec3(0.0);
  const glm::dvec3 ray_object = object.object_from_device * glm::dvec3(d, 1.0);
  const double slope = glm::dot(plane.normal_object, ray_object);
  double depth =
      (plane.distance - glm::dot(plane.normal_object, object.camera_from_center + beside_object)) / slope;
  if (!(std::abs(depth - embree_depth) <= 1e-3 * embree_depth)) depth = embree_depth;
  map.depth_m.values[p] = depth;
  map.point_object.values[p] = object.camera_object + beside_object + depth * ray_object;
  map.seen_front.values[p] = slope < 0;
  map.albedo.values[p] = slope < 0 ? object.albedo : object.back_albedo;
}

void apply_albedo_map(SurfaceMap& map, std::size_t p, const Object& object, std::uint32_t triangle) {
  const glm::dvec2 st = texture_coordinates_at(object.mesh, triangle, map.point_object.values[p]);
  map.albedo.values[p] *= static_cast<float>(albedo_map_value(*object.albedo_map, st));
}

void write_tile(SurfaceMap& map, const Tile& tile, const CameraView& view, const RayScene& scene, int x0,
                int y0) {
  for (int j = 0; j < tile.count_y; ++j) {
    for (int i = 0; i < tile.count_x; ++i) {
      const int lane = j * tile_edge + i;
      const std::size_t p = map.object.index(x0 + i, y0 + j);
      const std::uint32_t id = tile.hits.object[lane], triangle = tile.hits.triangle[lane];
      if (!tile.rays.valid[lane] || id == no_hit) {
        write_miss(map, p);
        continue;
      }
      map.object.values[p] = id;
      map.triangle.values[p] = triangle;
      const ObjectView& object = view.objects[id];
      write_hit(map, p, object, scene.plane(id, triangle), tile.direction[lane],
                tile.lens ? &tile.start_m[lane] : nullptr, tile.hits.t[lane]);
      if (object.textured) apply_albedo_map(map, p, *object.textured, triangle);
    }
  }
}

}  // namespace

CameraView make_camera_view(const RayScene& rays, const Scene& scene, const Camera& camera) {
  const Rigid world_from_device = inverse(camera.device.device_from_world);
  const glm::dvec3 camera_world = world_from_device.translation;
  CameraView view{camera_world - rays.center_world(), world_from_device.rotation, {}};
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    const ObjectPlanes& planes = rays.objects()[i];
    const glm::dvec3 camera_object =
        planes.object_from_world_linear * (camera_world - glm::dvec3(object.world_from_object[3]));
    const bool textured = object.albedo_map && !object.mesh.texture_coordinates.empty();
    view.objects.push_back({planes.object_from_world_linear * view.world_from_device,
                            camera_object - planes.center_object, camera_object, float(object.albedo),
                            scene.effects.back_face ? 0 : float(object.albedo),
                            textured ? &object : nullptr});
  }
  return view;
}

SurfaceMap make_surface_map(const PixelRegion& region) {
  const int w = region.width, h = region.height;
  return {w, h, {w, h}, {w, h}, {w, h}, {w, h}, {w, h}, {w, h}, {region.x, region.y}};
}

void trace_surface_tiles(const RayScene& rays, const CameraView& view, const CameraRays& directions,
                         int tile_row, SurfaceMap& map, const glm::vec2* offsets_px, const LensPoints* lens) {
  const int y0 = tile_row * tile_edge;
  Tile tile;
  tile.lens = lens;
  std::fill_n(tile.rays.origin_x, packet_size, static_cast<float>(view.camera_relative.x));
  std::fill_n(tile.rays.origin_y, packet_size, static_cast<float>(view.camera_relative.y));
  std::fill_n(tile.rays.origin_z, packet_size, static_cast<float>(view.camera_relative.z));
  std::fill_n(tile.rays.end, packet_size, std::numeric_limits<float>::infinity());
  tile.count_y = std::min(tile_edge, map.height - y0);
  for (int x0 = 0; x0 < map.width; x0 += tile_edge) {
    tile.count_x = std::min(tile_edge, map.width - x0);
    const glm::vec2* offsets = offsets_px ? offsets_px + map.object.index(x0, y0) : nullptr;
    if (lens) start_on_lens(tile, view, map.object.index(x0, y0), map.width);
    aim(tile, view, directions, map.first_px + glm::ivec2(x0, y0), offsets, map.width);
    rays.first_hits(tile.rays, tile.hits);
    write_tile(map, tile, view, rays, x0, y0);
  }
}

SurfaceMap trace_surface(const RayScene& rays, const Scene& scene, const Camera& camera,
                         const CameraRays& directions) {
  const CameraView view = make_camera_view(rays, scene, camera);
  SurfaceMap map = make_surface_map({0, 0, directions.width(), directions.height()});
  parallel_for((map.height + tile_edge - 1) / tile_edge,
               [&](std::size_t row) { trace_surface_tiles(rays, view, directions, int(row), map); });
  return map;
}

SurfaceMap trace_surface(const RayScene& rays, const Scene& scene, const Camera& camera) {
  return trace_surface(rays, scene, camera, CameraRays(camera.device));
}

PixelArray<glm::dvec3> points_world(const SurfaceMap& surface, const Scene& scene) {
  PixelArray<glm::dvec3> points(surface.width, surface.height);
  for (std::size_t p = 0; p < points.values.size(); ++p) {
    points.values[p] = surface.hit(p) ? glm::dvec3(scene.objects[surface.object.values[p]].world_from_object *
                                                   glm::dvec4(surface.point_object.values[p], 1.0))
                                      : glm::dvec3(nan);
  }
  return points;
}

PixelArray<glm::dvec3> normals_world(const SurfaceMap& surface, const RayScene& rays) {
  PixelArray<glm::dvec3> normals(surface.width, surface.height);
  for (std::size_t p = 0; p < normals.values.size(); ++p) {
    normals.values[p] = surface.hit(p)
                            ? rays.plane(surface.object.values[p], surface.triangle.values[p]).normal_world
                            : glm::dvec3(0.0);
  }
  return normals;
}

}  // namespace laterna
