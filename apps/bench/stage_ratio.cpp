#include "apps/bench/stage_ratio.h"

#include "apps/bench/timing.h"
#include "render/direct_light.h"
#include "render/image_rows.h"
#include "sim/instruction_sets.h"
#include "sim/parallel.h"
#include "sim/shapes.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>

namespace laterna {

namespace {

// The rays of the visibility stage, made once: directions of camera rays, and whole shadow rays, tile by
// tile.
struct ReadyRays {
  int tiles_x = 0, tiles_y = 0;
  std::vector<RayPacket> camera, shadow;
  double count = 0;
};

void add_pixel(ReadyRays& ready, std::size_t tile, int lane, std::size_t p, const SurfaceMap& surface,
               const LightMap& light, const glm::dvec3& point_world, const glm::dvec3& camera,
               const glm::dvec3& projector, const glm::dvec3& direction, const RayScene& rays) {
  const glm::dvec3 origin = camera - rays.center_world();
  RayPacket& c = ready.camera[tile];
  c.origin_x[lane] = float(origin.x), c.origin_y[lane] = float(origin.y), c.origin_z[lane] = float(origin.z);
  c.direction_x[lane] = float(direction.x), c.direction_y[lane] = float(direction.y),
  c.direction_z[lane] = float(direction.z);
  c.end[lane] = std::numeric_limits<float>::infinity();
  c.valid[lane] = -1;
  ++ready.count;
  const auto why = Unlit(light.why.values[p]);
  if (why != Unlit::lit && why != Unlit::shadow) return;
  const TrianglePlane& plane = rays.plane(surface.object.values[p], surface.triangle.values[p]);
  const glm::dvec3 start = point_world + plane.margin_m * plane.normal_world;
  const glm::dvec3 from = start - rays.center_world(), towards = projector - start;
  RayPacket& s = ready.shadow[tile];
  s.origin_x[lane] = float(from.x), s.origin_y[lane] = float(from.y), s.origin_z[lane] = float(from.z);
  s.direction_x[lane] = float(towards.x), s.direction_y[lane] = float(towards.y),
  s.direction_z[lane] = float(towards.z);
  s.end[lane] = 1;
  s.valid[lane] = -1;
  ++ready.count;
}

ReadyRays make_ready(const Scene& scene, const RayScene& rays) {
  const Device& camera = scene.cameras[0].device;
  const SurfaceMap surface = trace_surface(rays, scene, scene.cameras[0]);
  const LightMap light = trace_light(rays, scene, surface, scene.projectors[0]);
  const CameraRays directions(camera);
  const Rigid world_from_camera = inverse(camera.device_from_world);
  const glm::dvec3 projector = center_in_world(scene.projectors[0].device.device_from_world);
  const PixelArray<glm::dvec3> points = points_world(surface, scene);
  ReadyRays ready;
  ready.tiles_x = (surface.width + 3) / 4, ready.tiles_y = (surface.height + 3) / 4;
  ready.camera.resize(std::size_t(ready.tiles_x) * ready.tiles_y);
  ready.shadow.resize(ready.camera.size());
  for (int y = 0; y < surface.height; ++y) {
    for (int x = 0; x < surface.width; ++x) {
      const glm::dvec3 d = world_from_camera.rotation * glm::dvec3(directions.direction(x, y), 1.0);
      add_pixel(ready, std::size_t(y / 4) * ready.tiles_x + x / 4, y % 4 * 4 + x % 4,
                surface.object.index(x, y), surface, light, points(x, y), world_from_camera.translation,
                projector, d, rays);
    }
  }
  return ready;
}

// A scene in Embree's hands alone.
struct BareScene {
  RTCDevice device = rtcNewDevice(embree_configuration().c_str());
  RTCScene scene = rtcNewScene(device);

  BareScene(const Scene& source, const glm::dvec3& center, bool robust) {
    if (robust) rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    for (const Object& object : source.objects) {
      RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
      const std::vector<glm::dvec3> world = world_positions(object);
      auto* v = static_cast<float*>(
          rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, world.size()));
      for (const glm::dvec3& p : world)
        for (int i = 0; i < 3; ++i) *v++ = float(p[i] - center[i]);
      auto* t = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
          geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, object.mesh.triangles.size()));
      std::memcpy(t, object.mesh.triangles.data(), object.mesh.triangles.size() * 12);
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene, geometry);
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene);
  }
  BareScene(const BareScene&) = delete;
  BareScene& operator=(const BareScene&) = delete;
  ~BareScene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

template <int Width, class Ray>
void load(Ray& ray, const RayPacket& rays, int first) {
  constexpr std::size_t bytes = Width * sizeof(float);
  std::memcpy(ray.org_x, rays.origin_x + first, bytes);
  std::memcpy(ray.org_y, rays.origin_y + first, bytes);
  std::memcpy(ray.org_z, rays.origin_z + first, bytes);
  std::memcpy(ray.dir_x, rays.direction_x + first, bytes);
  std::memcpy(ray.dir_y, rays.direction_y + first, bytes);
  std::memcpy(ray.dir_z, rays.direction_z + first, bytes);
  std::memcpy(ray.tfar, rays.end + first, bytes);
  for (int i = 0; i < Width; ++i) ray.tnear[i] = 0, ray.time[i] = 0, ray.mask[i] = ~0u, ray.flags[i] = 0;
}

template <int Width, class RayHit, class Ray, class Intersect, class Occluded>
unsigned play(const BareScene& bare, const ReadyRays& ready, std::size_t row, RTCIntersectContext context,
              Intersect intersect, Occluded occluded) {
  unsigned found = 0;
  for (std::size_t tile = row * ready.tiles_x; tile < (row + 1) * std::size_t(ready.tiles_x); ++tile) {
    for (int first = 0; first < packet_size; first += Width) {
      RayHit hit;
      load<Width>(hit.ray, ready.camera[tile], first);
      for (int i = 0; i < Width; ++i) hit.hit.geomID[i] = hit.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
      intersect(ready.camera[tile].valid + first, bare.scene, &context, &hit);
      found += hit.hit.primID[0];
    }
    for (int first = 0; first < packet_size; first += Width) {
      Ray ray;
      load<Width>(ray, ready.shadow[tile], first);
      occluded(ready.shadow[tile].valid + first, bare.scene, &context, &ray);
      found += ray.tfar[0] < 0;
    }
  }
  return found;
}

unsigned run_bare(const BareScene& bare, const ReadyRays& ready, const BareWay& way) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (way.coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  std::atomic<unsigned> found = 0;
  parallel_for(ready.tiles_y, [&](std::size_t row) {
    found += way.width == 16
                 ? play<16, RTCRayHit16, RTCRay16>(bare, ready, row, context, rtcIntersect16, rtcOccluded16)
                 : play<8, RTCRayHit8, RTCRay8>(bare, ready, row, context, rtcIntersect8, rtcOccluded8);
  });
  return found;
}

}  // namespace

std::string describe(const BareWay& way) {
  return fmt::format("{} wide{}{}", way.width, way.coherent ? ", coherent" : "",
                     way.robust ? ", robust" : "");
}

Scene bench_scene(int triangles) {
  const int rows = std::max(1, int(std::lround(std::sqrt(triangles / 3.2))));
  Object relief_object;
  relief_object.name = "relief";
  relief_object.mesh = relief(1.6, 1.0, 0.3, triangles / 2 / rows, rows);
  Camera camera;
  camera.device.name = "camera";
  camera.device.intrinsics = {{1280, 800}, 1600, 1600, 639.5, 399.5};
  camera.device.device_from_world = device_from_world_looking_at({0.4, 0.1, 2}, {0, 0, 0}, {0, 1, 0});
  Projector projector;
  projector.device.name = "projector";
  projector.device.intrinsics = intrinsics_from_throw({1280, 800}, 1.2, {0, 0});
  projector.device.device_from_world = device_from_world_looking_at({-0.4, 0, 2}, {0, 0, 0}, {0, 1, 0});
  Scene scene;
  scene.objects = {relief_object};
  scene.cameras = {camera};
  scene.projectors = {projector};
  return scene;
}

namespace {

// What laterna capture does for each region of the image, up to the rows.
struct Visibility {
  const RayScene& rays;
  CameraRays directions;
  CameraView camera;
  ProjectorView projector;

  Visibility(const RayScene& ready, const Scene& scene)
      : rays(ready),
        directions(scene.cameras[0].device),
        camera(make_camera_view(ready, scene, scene.cameras[0])),
        projector(make_projector_view(ready, scene, scene.projectors[0])) {}

  void trace(const PixelRegion& region) const {
    SurfaceMap surface = make_surface_map(region);
    LightMap light = make_light_map(region.width, region.height);
    for (int row = 0; row * tile_edge < region.height; ++row) {
      trace_surface_tiles(rays, camera, directions, row, surface);
      trace_light_tiles(rays, projector, surface, row, light);
    }
  }
  void trace() const {
    const ImageRows image{{directions.width(), directions.height()},
                          [&](LightRows& rows) { trace(rows.region); }};
    for_each_region(image, [](LightRows&, std::size_t) {});
  }
};

}  // namespace

VisibilityTimes visibility_over_embree(const Scene& scene, const BareWay& way, int repeats) {
  const RayScene rays(scene);
  const ReadyRays ready = make_ready(scene, rays);
  const BareScene bare(scene, rays.center_world(), way.robust);
  const Visibility visibility(rays, scene);
  std::vector<double> visibility_s, bare_s, ratio;
  volatile unsigned sink = 0;
  for (int i = -1; i < repeats; ++i) {  // the first round warms up
    const double a = seconds([&] { visibility.trace(); });
    const double b = seconds([&] { sink = run_bare(bare, ready, way); });
    if (i < 0) continue;
    visibility_s.push_back(a), bare_s.push_back(b), ratio.push_back(a / b);
  }
  static_cast<void>(sink);
  return {median(visibility_s), median(bare_s), ready.count, median(ratio)};
}

}  // namespace laterna
