#include "render/direct_light.h"

#include "sim/parallel.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace laterna {

namespace {

// How far before the projector's centre a shadow ray ends, as a share of its length: 2⁻²⁰, 1 µm per metre.
constexpr float shadow_ray_end = 1 - 0x1p-20f;

// The projector without what is switched off.
Projector switched(Projector projector, const Effects& effects) {
  if (!effects.border) projector.border = Border::clamp;
  if (!effects.light_planes) projector.device.planes = {};
  return projector;
}

// A tile while it is lit.
struct Tile {
  int x0, y0, count_x, count_y;  // in the map
  std::uint32_t object[packet_size];
  TilePoints points;
  TilePixels pixels;
  TileLight light;
  RayPacket shadow_rays;
};

void read_pixel(Tile& tile, int lane, std::size_t p, const SurfaceMap& surface, const RayScene& rays) {
  tile.object[lane] = surface.object.values[p];
  if (tile.object[lane] == no_hit) return;
  const TrianglePlane& plane = rays.plane(tile.object[lane], surface.triangle.values[p]);
  const glm::dvec3& x = surface.point_object.values[p];
  TilePoints& t = tile.points;
  t.x[lane] = x.x, t.y[lane] = x.y, t.z[lane] = x.z;
  t.normal_x[lane] = plane.normal_world.x, t.normal_y[lane] = plane.normal_world.y;
  t.normal_z[lane] = plane.normal_world.z, t.margin_m[lane] = plane.margin_m;
  t.front[lane] = surface.seen_front.values[p];
}

void read_tile(Tile& tile, const SurfaceMap& surface, const RayScene& rays) {
  if (tile.count_x < tile_edge || tile.count_y < tile_edge) std::fill_n(tile.object, packet_size, no_hit);
  for (int j = 0; j < tile.count_y; ++j)
    for (int i = 0; i < tile.count_x; ++i)
      read_pixel(tile, j * tile_edge + i, surface.object.index(tile.x0 + i, tile.y0 + j), surface, rays);
}

void apply_lens(const ProjectiveLookup& lookup, TilePixels& pixels) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (int lane = 0; lane < packet_size; ++lane) {
    if (!(pixels.q[lane] > 0)) continue;
    ProjectedPoint point{pixels.u_px[lane], pixels.v_px[lane], pixels.q[lane], 0, Unlit::lit};
    const bool mapped = lookup.warp(point);
    pixels.u_px[lane] = mapped ? point.u_px : nan;
    pixels.v_px[lane] = mapped ? point.v_px : nan;
    pixels.pixels_per_unit_area[lane] = point.pixels_per_unit_area;
  }
}

void light_object(Tile& tile, const ObjectLight& object) {
  project_tile(object.terms.lookup, tile.points, tile.pixels);
  if (!object.lookup.is_pinhole()) apply_lens(object.lookup, tile.pixels);
  light_tile(object.terms, tile.points, tile.pixels, tile.light, tile.shadow_rays);
}

void copy_lane(const Tile& from, int lane, Tile& to) {
  to.pixels.u_px[lane] = from.pixels.u_px[lane], to.pixels.v_px[lane] = from.pixels.v_px[lane];
  to.light.white_lx[lane] = from.light.white_lx[lane], to.light.why[lane] = from.light.why[lane];
  const RayPacket& a = from.shadow_rays;
  RayPacket& b = to.shadow_rays;
  b.origin_x[lane] = a.origin_x[lane], b.direction_x[lane] = a.direction_x[lane];
  b.origin_y[lane] = a.origin_y[lane], b.direction_y[lane] = a.direction_y[lane];
  b.origin_z[lane] = a.origin_z[lane], b.direction_z[lane] = a.direction_z[lane];
  b.valid[lane] = a.valid[lane];
}

void clear_lane(Tile& tile, int lane) {
  tile.pixels.u_px[lane] = tile.pixels.v_px[lane] = std::numeric_limits<double>::quiet_NaN();
  tile.light.white_lx[lane] = 0;
  tile.light.why[lane] = int(Unlit::no_surface);
  tile.shadow_rays.valid[lane] = 0;
}

// Everything but the shadow; fills the shadow rays of the points that are still lit.
void light_points(Tile& tile, const ProjectorView& light) {
  const std::uint32_t* end = tile.object + packet_size;
  const std::uint32_t* first =
      std::find_if(tile.object, const_cast<std::uint32_t*>(end), [](std::uint32_t o) { return o != no_hit; });
  if (first != end) light_object(tile, light.objects[*first]);
  for (int lane = 0; lane < packet_size; ++lane) {
    const std::uint32_t object = tile.object[lane];
    if (object == no_hit) {
      clear_lane(tile, lane);
    } else if (object != *first) {
      Tile other = tile;
      light_object(other, light.objects[object]);
      copy_lane(other, lane, tile);
    }
  }
}

void write_tile(const Tile& tile, LightMap& map) {
  for (int j = 0; j < tile.count_y; ++j) {
    const int lane = j * tile_edge;
    const std::size_t p = map.u_px.index(tile.x0, tile.y0 + j);
    copy_row(tile.pixels.u_px + lane, tile.count_x, &map.u_px.values[p]);
    copy_row(tile.pixels.v_px + lane, tile.count_x, &map.v_px.values[p]);
    copy_row(tile.light.white_lx + lane, tile.count_x, &map.white_lx.values[p]);
    for (int i = 0; i < tile.count_x; ++i) map.why.values[p + i] = std::uint8_t(tile.light.why[lane + i]);
  }
}

}  // namespace

ProjectorView make_projector_view(const RayScene& rays, const Scene& scene, const Projector& given) {
  const Projector projector = switched(given, scene.effects);
  const glm::dvec3 center = center_in_world(projector.device.device_from_world);
  const Intrinsics& k = projector.device.intrinsics;
  const double flux = projector.flux_lm / (double(k.size.x) * k.size.y);
  ProjectorView light;
  for (const Object& object : scene.objects) {
    const glm::dmat4& m = object.world_from_object;
    const ProjectiveLookup lookup(projector, m);
    light.objects.push_back({lookup,
                             {lookup.terms(), glm::dmat3(m), glm::dvec3(m[3]) - rays.center_world(),
                              center - rays.center_world(), flux, flux * k.fx * k.fy, scene.effects.back_face,
                              scene.effects.irradiance, scene.effects.shadow}});
  }
  return light;
}

LightMap make_light_map(int width, int height) {
  return {width, height, {width, height}, {width, height}, {width, height}, {width, height}};
}

void trace_light_tiles(const RayScene& rays, const ProjectorView& light, const SurfaceMap& surface,
                       int tile_row, LightMap& map) {
  Tile tile{};
  tile.shadow_rays = make_ray_packet();
  tile.y0 = tile_row * tile_edge;
  tile.count_y = std::min(tile_edge, map.height - tile.y0);
  for (tile.x0 = 0; tile.x0 < map.width; tile.x0 += tile_edge) {
    tile.count_x = std::min(tile_edge, map.width - tile.x0);
    read_tile(tile, surface, rays);
    light_points(tile, light);
    std::fill_n(tile.shadow_rays.end, packet_size, shadow_ray_end);
    for (std::uint32_t blocked = rays.trace_shadows(tile.shadow_rays); blocked; blocked &= blocked - 1) {
      const int lane = std::countr_zero(blocked);
      tile.light.why[lane] = int(Unlit::shadow);
      tile.light.white_lx[lane] = 0;
    }
    write_tile(tile, map);
  }
}

LightMap trace_light(const RayScene& rays, const Scene& scene, const SurfaceMap& surface,
                     const Projector& projector) {
  const ProjectorView light = make_projector_view(rays, scene, projector);
  LightMap map = make_light_map(surface.width, surface.height);
  parallel_for((map.height + tile_edge - 1) / tile_edge,
               [&](std::size_t row) { trace_light_tiles(rays, light, surface, int(row), map); });
  return map;
}

}  // namespace laterna
