#include "render/surface.h"

#include "render/albedo.h"
#include "render/tile_kernels.h"
#include "sim/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace laterna {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// One tile of a camera's image while it is traced.
struct Tile {
  int x0, y0, count_x, count_y;  // in the map; pixels inside it
  TileRays directions;
  HitPacket hits;
};

// `offsets_px`: null, or one per pixel of the map.
void aim(Tile& tile, const CameraRays& directions, const SurfaceMap& map, const glm::vec2* offsets_px) {
  const glm::ivec2 camera = map.first_px + glm::ivec2(tile.x0, tile.y0);
  if (tile.count_x == tile_edge && tile.count_y == tile_edge && !offsets_px)
    return directions.tile(camera, tile.directions.x, tile.directions.y);
  for (int lane = 0; lane < packet_size; ++lane) {
    const int i = lane % tile_edge, j = lane / tile_edge;
    glm::dvec2 d(nan);
    if (i < tile.count_x && j < tile.count_y)
      d = offsets_px ? directions.direction(camera.x + i, camera.y + j,
                                            offsets_px[map.object.index(tile.x0 + i, tile.y0 + j)])
                     : directions.direction(camera.x + i, camera.y + j);
    tile.directions.x[lane] = d.x, tile.directions.y[lane] = d.y;
  }
}

// Moves the rays' starts to the lens, and turns them about where they meet in focus.
void start_on_lens(Tile& tile, const CameraView& view, const SurfaceMap& map, const LensPoints& lens,
                   RayPacket& packet) {
  tile.directions.from_lens = true;
  for (int lane = 0; lane < packet_size; ++lane) {
    const int i = lane % tile_edge, j = lane / tile_edge;
    const bool inside = i < tile.count_x && j < tile.count_y;
    const glm::dvec2 at =
        inside ? glm::dvec2(lens.points_m[map.object.index(tile.x0 + i, tile.y0 + j)]) : glm::dvec2(0.0);
    const glm::dvec3 start = view.camera_relative + view.world_from_device * glm::dvec3(at, 0.0);
    tile.directions.start_x_m[lane] = at.x, tile.directions.start_y_m[lane] = at.y;
    tile.directions.x[lane] -= at.x / lens.focus_m, tile.directions.y[lane] -= at.y / lens.focus_m;
    packet.origin_x[lane] = static_cast<float>(start.x);
    packet.origin_y[lane] = static_cast<float>(start.y);
    packet.origin_z[lane] = static_cast<float>(start.z);
  }
}

// Planes are far apart in memory: they are asked for when the hit is known and used a row of tiles later.
void fetch_planes_ahead(const HitPacket& hits, const RayScene& scene) {
  for (int lane = 0; lane < packet_size; ++lane)
    if (hits.object[lane] != no_hit) __builtin_prefetch(&scene.plane(hits.object[lane], hits.triangle[lane]));
}

void gather_planes(const Tile& tile, const RayScene& scene, TilePlanes& planes) {
  for (int lane = 0; lane < packet_size; ++lane) {
    if (tile.hits.object[lane] == no_hit) continue;
    const TrianglePlane& plane = scene.plane(tile.hits.object[lane], tile.hits.triangle[lane]);
    planes.normal_x[lane] = plane.normal_object.x, planes.normal_y[lane] = plane.normal_object.y;
    planes.normal_z[lane] = plane.normal_object.z, planes.distance[lane] = plane.distance;
  }
}

void refine_object(const Tile& tile, const TilePlanes& planes, const ObjectView& o, TileSurface& surface) {
  refine_tile(o.object_from_device, o.camera_from_center, o.camera_object, tile.directions, planes,
              tile.hits.t, surface);
}

void copy_lane(const TileSurface& from, int lane, TileSurface& to) {
  to.depth_m[lane] = from.depth_m[lane], to.slope[lane] = from.slope[lane];
  to.x[lane] = from.x[lane], to.y[lane] = from.y[lane], to.z[lane] = from.z[lane];
}

void refine(const Tile& tile, const TilePlanes& planes, const CameraView& view, TileSurface& surface) {
  const std::uint32_t* object = tile.hits.object;
  int first = 0;
  while (first < packet_size && object[first] == no_hit) ++first;
  if (first < packet_size) refine_object(tile, planes, view.objects[object[first]], surface);
  for (int lane = 0; lane < packet_size; ++lane) {
    if (object[lane] == no_hit) {
      surface.depth_m[lane] = surface.x[lane] = surface.y[lane] = surface.z[lane] = nan;
      surface.slope[lane] = 0;
    } else if (object[lane] != object[first]) {
      TileSurface other;
      refine_object(tile, planes, view.objects[object[lane]], other);
      copy_lane(other, lane, surface);
    }
  }
}

float albedo_of(const Tile& tile, int lane, const TileSurface& surface, const CameraView& view) {
  const std::uint32_t id = tile.hits.object[lane];
  if (id == no_hit) return 0;
  const ObjectView& object = view.objects[id];
  const float albedo = surface.slope[lane] < 0 ? object.albedo : object.back_albedo;
  if (!object.textured) return albedo;
  const glm::dvec2 st = texture_coordinates_at(object.textured->mesh, tile.hits.triangle[lane],
                                               {surface.x[lane], surface.y[lane], surface.z[lane]});
  return albedo * static_cast<float>(albedo_map_value(*object.textured->albedo_map, st));
}

void write_tile(SurfaceMap& map, const Tile& tile, const TileSurface& surface, const CameraView& view) {
  for (int j = 0; j < tile.count_y; ++j) {
    const int first = j * tile_edge;
    const std::size_t p = map.object.index(tile.x0, tile.y0 + j);
    copy_row(tile.hits.object + first, tile.count_x, &map.object.values[p]);
    copy_row(tile.hits.triangle + first, tile.count_x, &map.triangle.values[p]);
    copy_row(surface.depth_m + first, tile.count_x, &map.depth_m.values[p]);
    for (int i = 0; i < tile.count_x; ++i) {
      const int lane = first + i;
      map.point_object.values[p + i] = {surface.x[lane], surface.y[lane], surface.z[lane]};
      map.seen_front.values[p + i] = surface.slope[lane] < 0;
      map.albedo.values[p + i] = albedo_of(tile, lane, surface, view);
    }
  }
}

RayPacket packet_from(const CameraView& view) {
  RayPacket rays = make_ray_packet();
  std::fill_n(rays.origin_x, packet_size, static_cast<float>(view.camera_relative.x));
  std::fill_n(rays.origin_y, packet_size, static_cast<float>(view.camera_relative.y));
  std::fill_n(rays.origin_z, packet_size, static_cast<float>(view.camera_relative.z));
  return rays;
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
  RayPacket packet = packet_from(view);
  std::vector<Tile> tiles((map.width + tile_edge - 1) / tile_edge);
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    Tile& tile = tiles[k];
    tile.x0 = int(k) * tile_edge, tile.y0 = tile_row * tile_edge;
    tile.count_x = std::min(tile_edge, map.width - tile.x0);
    tile.count_y = std::min(tile_edge, map.height - tile.y0);
    aim(tile, directions, map, offsets_px);
    if (lens) start_on_lens(tile, view, map, *lens, packet);
    aim_tile(view.world_from_device, tile.directions, packet);
    std::fill_n(packet.end, packet_size, std::numeric_limits<float>::infinity());
    rays.trace(packet);
    std::copy_n(packet.end, packet_size, tile.hits.t);
    std::copy_n(packet.object, packet_size, tile.hits.object);
    std::copy_n(packet.triangle, packet_size, tile.hits.triangle);
    fetch_planes_ahead(tile.hits, rays);
  }
  TilePlanes planes{};
  TileSurface surface;
  for (const Tile& tile : tiles) {
    gather_planes(tile, rays, planes);
    refine(tile, planes, view, surface);
    write_tile(map, tile, surface, view);
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
  parallel_for(surface.height, [&](std::size_t y) {
    for (std::size_t p = y * surface.width; p < (y + 1) * surface.width; ++p)
      points.values[p] = surface.hit(p)
                             ? glm::dvec3(scene.objects[surface.object.values[p]].world_from_object *
                                          glm::dvec4(surface.point_object.values[p], 1.0))
                             : glm::dvec3(nan);
  });
  return points;
}

PixelArray<glm::dvec3> normals_world(const SurfaceMap& surface, const RayScene& rays) {
  PixelArray<glm::dvec3> normals(surface.width, surface.height);
  for (std::size_t p = 0; p < normals.values.size(); ++p) normals.values[p] = normal_world(surface, rays, p);
  return normals;
}

}  // namespace laterna
