#include "render/ray_scene.h"

#include "sim/instruction_sets.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <cstring>
#include <limits>
#include <stdexcept>

namespace laterna {

namespace {

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct ReleaseGeometry {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using DeviceHandle = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using SceneHandle = std::unique_ptr<RTCSceneTy, ReleaseScene>;
using GeometryHandle = std::unique_ptr<RTCGeometryTy, ReleaseGeometry>;

#ifdef LATERNA_PLAIN_THREADS  // for ThreadSanitizer, which cannot follow Embree's own threads
constexpr const char* embree_threads = "threads=1,";
#else
constexpr const char* embree_threads = "";
#endif

// Embree calls this from its own code, through which no exception may pass: keep the first message for later.
void remember(void* where, RTCError code, const char* message) {
  auto& kept = *static_cast<std::string*>(where);
  if (kept.empty()) kept = fmt::format("Embree: error {}: {}", int(code), message ? message : "no message");
}

glm::dvec3 middle(const std::vector<std::vector<glm::dvec3>>& objects) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  glm::dvec3 low(infinity), high(-infinity);
  for (const auto& positions : objects)
    for (const glm::dvec3& p : positions) low = glm::min(low, p), high = glm::max(high, p);
  return low.x <= high.x ? 0.5 * (low + high) : glm::dvec3(0.0);
}

RTCIntersectContext context_for(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

}  // namespace

struct RayScene::Embree {
  std::string error;  // first, so that it outlives the device that writes to it
  DeviceHandle device;
  SceneHandle scene;
  bool sixteen_wide = false;

  void check() const {
    if (!error.empty()) throw std::runtime_error(error);
  }
  void open();
  void add(unsigned id, const std::vector<glm::dvec3>& world, const Mesh& mesh, const glm::dvec3& center);
};

void RayScene::Embree::open() {
  device.reset(rtcNewDevice((embree_threads + embree_configuration()).c_str()));
  if (!device) throw std::runtime_error("Embree: no device could be opened");
  rtcSetDeviceErrorFunction(device.get(), remember, &error);
  sixteen_wide = rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
  scene.reset(rtcNewScene(device.get()));
  check();
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);  // no light between neighbouring triangles
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
}

void RayScene::Embree::add(unsigned id, const std::vector<glm::dvec3>& world, const Mesh& mesh,
                           const glm::dvec3& center) {
  if (mesh.triangles.empty()) return;
  const GeometryHandle geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  check();
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 12, world.size()));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size()));
  check();
  for (const glm::dvec3& x_world : world) {
    const glm::dvec3 x = x_world - center;
    for (int i = 0; i < 3; ++i) *vertices++ = static_cast<float>(x[i]);
  }
  for (const glm::uvec3& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) *indices++ = t[i];
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(scene.get(), geometry.get(), id);
  check();
}

RayScene::RayScene(const Scene& scene) : embree_(std::make_unique<Embree>()), center_world_(0.0) {
  std::vector<std::vector<glm::dvec3>> world;
  world.reserve(scene.objects.size());
  for (const Object& object : scene.objects) world.push_back(world_positions(object));
  center_world_ = middle(world);
  for (const Object& object : scene.objects)
    objects_.push_back(make_planes(object, center_world_, shadow_margin_factor));
  embree_->open();
  for (std::size_t i = 0; i < world.size(); ++i)
    embree_->add(unsigned(i), world[i], scene.objects[i].mesh, center_world_);
  rtcCommitScene(embree_->scene.get());
  embree_->check();
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

namespace {

// One half or the whole of a packet, in Embree's layout. Both widths keep their arrays in the same order.
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

template <int Width, class RayHit, class Intersect>
void intersect(const Intersect& call, const RayPacket& rays, int first, HitPacket& hits) {
  RayHit rayhit;
  load<Width>(rayhit.ray, rays, first);
  for (int i = 0; i < Width; ++i) rayhit.hit.geomID[i] = rayhit.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  call(rays.valid + first, rayhit);
  std::memcpy(hits.t + first, rayhit.ray.tfar, Width * sizeof(float));
  std::memcpy(hits.object + first, rayhit.hit.geomID, Width * sizeof(float));
  std::memcpy(hits.triangle + first, rayhit.hit.primID, Width * sizeof(float));
}

// Embree sets tfar to -infinity where a ray is blocked.
template <int Width, class Ray, class Occluded>
std::uint32_t shadow(const Occluded& call, const RayPacket& rays, int first) {
  Ray ray;
  load<Width>(ray, rays, first);
  call(rays.valid + first, ray);
  std::uint32_t blocked = 0;
  for (int i = 0; i < Width; ++i)
    blocked |= std::uint32_t(rays.valid[first + i] != 0 && ray.tfar[i] < 0) << (first + i);
  return blocked;
}

}  // namespace

void RayScene::first_hits(const RayPacket& rays, HitPacket& hits, bool coherent) const {
  static_assert(no_hit == RTC_INVALID_GEOMETRY_ID);
  RTCScene scene = embree_->scene.get();
  RTCIntersectContext context = context_for(coherent);
  if (embree_->sixteen_wide) {
    const auto call = [&](const int* valid, RTCRayHit16& r) { rtcIntersect16(valid, scene, &context, &r); };
    intersect<16, RTCRayHit16>(call, rays, 0, hits);
    return;
  }
  const auto call = [&](const int* valid, RTCRayHit8& r) { rtcIntersect8(valid, scene, &context, &r); };
  intersect<8, RTCRayHit8>(call, rays, 0, hits);
  intersect<8, RTCRayHit8>(call, rays, 8, hits);
}

std::uint32_t RayScene::occluded(const RayPacket& rays) const {
  RTCScene scene = embree_->scene.get();
  RTCIntersectContext context = context_for(true);
  if (embree_->sixteen_wide) {
    const auto call = [&](const int* valid, RTCRay16& r) { rtcOccluded16(valid, scene, &context, &r); };
    return shadow<16, RTCRay16>(call, rays, 0);
  }
  const auto call = [&](const int* valid, RTCRay8& r) { rtcOccluded8(valid, scene, &context, &r); };
  return shadow<8, RTCRay8>(call, rays, 0) | shadow<8, RTCRay8>(call, rays, 8);
}

}  // namespace laterna
