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

void aim_at_light(RayPacket& packet, int lane, const glm::dvec3& start, const glm::dvec3& towards) {
  packet.origin_x[lane] = static_cast<float>(start.x), packet.direction_x[lane] = float(towards.x);
  packet.origin_y[lane] = static_cast<float>(start.y), packet.direction_y[lane] = float(towards.y);
  packet.origin_z[lane] = static_cast<float>(start.z), packet.direction_z[lane] = float(towards.z);
  packet.valid[lane] = -1;
}

// Everything but the shadow; fills the shadow ray's lane where the point is still lit.
void light_pixel(LightMap& map, std::size_t p, RayPacket& packet, int lane, const ProjectorView& light,
                 const SurfaceMap& surface, const RayScene& rays) {
  packet.valid[lane] = 0;
  map.white_lx.values[p] = 0;
  if (!surface.hit(p)) {
    map.u_px.values[p] = map.v_px.values[p] = std::numeric_limits<double>::quiet_NaN();
    map.why.values[p] = std::uint8_t(Unlit::no_surface);
    return;
  }
  const std::uint32_t object = surface.object.values[p];
  const ObjectLight& view = light.objects[object];
  const glm::dvec3& point_object = surface.point_object.values[p];
  const ProjectedPoint hit = view.lookup.project(point_object);
  map.u_px.values[p] = hit.u_px;
  map.v_px.values[p] = hit.v_px;
  map.why.values[p] = std::uint8_t(hit.why);
  if (hit.why != Unlit::lit) return;
  const TrianglePlane& plane = rays.plane(object, surface.triangle.values[p]);
  const glm::dvec3 point = view.world_from_object_linear * point_object + view.object_relative;
  const double height = glm::dot(plane.normal_world, light.center_relative - point);
  const bool two_sided = !light.effects.back_face && height < 0;
  if (light.effects.back_face && (!(height > 0) || !surface.seen_front.values[p])) {
    map.why.values[p] = std::uint8_t(Unlit::back_face);
    return;
  }
  const double z = hit.depth_m;
  const double above = two_sided ? -height : height;
  map.white_lx.values[p] = light.effects.irradiance
                               ? light.flux_per_pixel_lm * hit.pixels_per_unit_area * above / (z * z * z)
                               : light.facing_at_1_m_lx;
  if (!light.effects.shadow) return;
  const glm::dvec3 start = point + (two_sided ? -plane.margin_m : plane.margin_m) * plane.normal_world;
  aim_at_light(packet, lane, start, light.center_relative - start);
}

}  // namespace

ProjectorView make_projector_view(const RayScene& rays, const Scene& scene, const Projector& given) {
  const Projector projector = switched(given, scene.effects);
  const glm::dvec3 center = center_in_world(projector.device.device_from_world);
  const Intrinsics& k = projector.device.intrinsics;
  const double flux = projector.flux_lm / (double(k.size.x) * k.size.y);
  ProjectorView light{scene.effects, center - rays.center_world(), flux, flux * k.fx * k.fy, {}};
  for (const Object& object : scene.objects) {
    const glm::dmat4& m = object.world_from_object;
    light.objects.push_back(
        {ProjectiveLookup(projector, m), glm::dmat3(m), glm::dvec3(m[3]) - rays.center_world()});
  }
  return light;
}

LightMap make_light_map(int width, int height) {
  return {width, height, {width, height}, {width, height}, {width, height}, {width, height}};
}

void trace_light_tiles(const RayScene& rays, const ProjectorView& light, const SurfaceMap& surface,
                       int tile_row, LightMap& map) {
  const int y0 = tile_row * tile_edge, y1 = std::min(y0 + tile_edge, map.height);
  RayPacket packet{};
  std::fill_n(packet.end, packet_size, shadow_ray_end);
  for (int x0 = 0; x0 < map.width; x0 += tile_edge) {
    const int x1 = std::min(x0 + tile_edge, map.width);
    std::fill_n(packet.valid, packet_size, 0);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x)
        light_pixel(map, map.u_px.index(x, y), packet, (y - y0) * tile_edge + x - x0, light, surface, rays);
    if (std::none_of(packet.valid, packet.valid + packet_size, [](int valid) { return valid != 0; }))
      continue;
    for (std::uint32_t blocked = rays.occluded(packet); blocked; blocked &= blocked - 1) {
      const int lane = std::countr_zero(blocked);
      const std::size_t p = map.u_px.index(x0 + lane % tile_edge, y0 + lane / tile_edge);
      map.why.values[p] = std::uint8_t(Unlit::shadow);
      map.white_lx.values[p] = 0;
    }
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
