#include "render/ray_scene.h"

#include "render/tile_kernels.h"
#include "sim/instruction_sets.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
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
  void intersect(RayPacket& rays, bool coherent) const;
  std::uint32_t block(RayPacket& rays) const;
  void add(unsigned id, const std::vector<glm::dvec3>& world, const Mesh& mesh, const glm::dvec3& center);
};

void RayScene::Embree::open() {
  device.reset(rtcNewDevice(embree_configuration().c_str()));
  if (!device) throw std::runtime_error("Embree: no device could be opened");
  rtcSetDeviceErrorFunction(device.get(), remember, &error);
  sixteen_wide = rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
  scene.reset(rtcNewScene(device.get()));
  check();
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

RayPacket make_ray_packet() {
  RayPacket rays{};
  std::fill_n(rays.mask, packet_size, ~0u);
  return rays;
}

namespace {

static_assert(no_hit == RTC_INVALID_GEOMETRY_ID);
static_assert(offsetof(RayPacket, direction_x) == offsetof(RTCRay16, dir_x));
static_assert(offsetof(RayPacket, end) == offsetof(RTCRay16, tfar));
static_assert(offsetof(RayPacket, flags) == offsetof(RTCRay16, flags));
static_assert(offsetof(RayPacket, triangle) == sizeof(RTCRay16) + offsetof(RTCHit16, primID));
static_assert(offsetof(RayPacket, instance) == sizeof(RTCRay16) + offsetof(RTCHit16, instID));

constexpr int half = packet_size / 2;

// Copies 8 lanes of each of the first `Arrays` arrays of a packet: in Embree's layouts of either width they
// come in the same order.
template <int Arrays>
void copy_half(const void* packet, int first, void* eight) {
  const auto* from = static_cast<const float*>(packet) + first;
  auto* to = static_cast<float*>(eight);
  for (int k = 0; k < Arrays; ++k) std::memcpy(to + k * half, from + k * packet_size, half * sizeof(float));
}
template <int Arrays>
void copy_back(const void* eight, int first, void* packet) {
  const auto* from = static_cast<const float*>(eight);
  auto* to = static_cast<float*>(packet) + first;
  for (int k = 0; k < Arrays; ++k) std::memcpy(to + k * packet_size, from + k * half, half * sizeof(float));
}
constexpr int ray_arrays = sizeof(RTCRay16) / sizeof(float) / packet_size;
constexpr int hit_arrays = sizeof(RTCRayHit16) / sizeof(float) / packet_size;

// Turns every ray by about 2⁻²¹, another way each time.
void turn(RayPacket& rays, int attempt) {
  constexpr float ways[3][3] = {{1, -2, 3}, {-3, 1, -2}, {2, 3, -1}};
  const float* way = ways[attempt];
  for (int i = 0; i < packet_size; ++i) {
    float &x = rays.direction_x[i], &y = rays.direction_y[i], &z = rays.direction_z[i];
    const float step = 0x1p-22f * std::max({std::abs(x), std::abs(y), std::abs(z)});
    x += way[0] * step, y += way[1] * step, z += way[2] * step;
  }
}
constexpr int attempts = 3;

void prepare(RayPacket& rays) {
  std::fill_n(rays.begin, packet_size, 0.f);
  std::fill_n(rays.time, packet_size, 0.f);
  std::fill_n(rays.mask, packet_size, ~0u);
  std::fill_n(rays.flags, packet_size, 0u);
}

std::uint32_t bits_of(const std::int32_t (&valid)[packet_size]) {
  std::uint32_t bits = 0;
  for (int i = 0; i < packet_size; ++i) bits |= std::uint32_t(valid[i] != 0) << i;
  return bits;
}

}  // namespace

void RayScene::Embree::intersect(RayPacket& rays, bool coherent) const {
  RTCIntersectContext context = context_for(coherent);
  std::fill_n(rays.object, packet_size, no_hit);
  std::fill_n(rays.triangle, packet_size, no_hit);
  std::fill_n(rays.instance, packet_size, no_hit);
  if (sixteen_wide) {
    rtcIntersect16(rays.valid, scene.get(), &context, reinterpret_cast<RTCRayHit16*>(&rays));
    return;
  }
  for (const int first : {0, half}) {
    RTCRayHit8 eight;
    copy_half<hit_arrays>(&rays, first, &eight);
    rtcIntersect8(rays.valid + first, scene.get(), &context, &eight);
    copy_back<hit_arrays>(&eight, first, &rays);
  }
}

// Embree sets tfar to -infinity where a ray is blocked.
std::uint32_t RayScene::Embree::block(RayPacket& rays) const {
  RTCIntersectContext context = context_for(true);
  if (sixteen_wide) {
    rtcOccluded16(rays.valid, scene.get(), &context, reinterpret_cast<RTCRay16*>(&rays));
    return blocked_lanes(rays);
  }
  for (const int first : {0, half}) {
    RTCRay8 eight;
    copy_half<ray_arrays>(&rays, first, &eight);
    rtcOccluded8(rays.valid + first, scene.get(), &context, &eight);
    copy_back<ray_arrays>(&eight, first, &rays);
  }
  return blocked_lanes(rays);
}

void RayScene::trace(RayPacket& rays, bool coherent) const {
  float end[packet_size];
  std::copy_n(rays.end, packet_size, end);
  embree_->intersect(rays, coherent);
  if (coherent && rays_disagree(rays)) close_gaps(rays, end);
}

void RayScene::close_gaps(RayPacket& rays, const float* end) const {
  RayPacket again = rays;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    std::copy_n(rays.direction_x, packet_size, again.direction_x);
    std::copy_n(rays.direction_y, packet_size, again.direction_y);
    std::copy_n(rays.direction_z, packet_size, again.direction_z);
    std::copy_n(end, packet_size, again.end);
    turn(again, attempt);
    embree_->intersect(again, true);
    bool found = false;
    for (int i = 0; i < packet_size; ++i) {
      if (again.object[i] == no_hit || !(again.end[i] < rays.end[i] * (1 - 1e-6f))) continue;
      rays.object[i] = again.object[i], rays.triangle[i] = again.triangle[i], rays.end[i] = again.end[i];
      found = true;
    }
    if (!found && attempt == 0) return;  // as it is at silhouettes
  }
}

void RayScene::first_hits(const RayPacket& given, HitPacket& hits, bool coherent) const {
  RayPacket rays = given;
  prepare(rays);
  trace(rays, coherent);
  std::copy_n(rays.end, packet_size, hits.t);
  std::copy_n(rays.object, packet_size, hits.object);
  std::copy_n(rays.triangle, packet_size, hits.triangle);
}

std::uint32_t RayScene::trace_shadows(RayPacket& rays) const {
  const std::uint32_t valid = bits_of(rays.valid);
  if (valid == 0) return 0;
  float end[packet_size];
  std::copy_n(rays.end, packet_size, end);
  std::uint32_t blocked = embree_->block(rays);
  const bool agree = blocked == valid || (blocked == 0 && valid == 0xffff);
  for (int attempt = 0; !agree && blocked != valid && attempt < attempts; ++attempt) {
    RayPacket again = rays;
    std::copy_n(end, packet_size, again.end);
    turn(again, attempt);
    const std::uint32_t found = embree_->block(again) & ~blocked;
    if (found == 0 && attempt == 0) break;  // as it is at a shadow's edge
    blocked |= found;
  }
  return blocked;
}

namespace {

// What Embree is told of a radius: wider by some steps of single precision of all lengths that play a part.
float safe_radius(double radius_m, double reach_m) {
  return float(radius_m * (1 + 0x1p-20) + 0x1p-20 * reach_m);
}

struct NearVisit {
  const std::function<double(std::uint32_t, std::uint32_t)>& closer;
  double reach_m;
};

bool visit_triangle(RTCPointQueryFunctionArguments* args) {
  const auto& visit = *static_cast<const NearVisit*>(args->userPtr);
  const float radius = safe_radius(visit.closer(args->geomID, args->primID), visit.reach_m);
  if (!(radius < args->query->radius)) return false;
  args->query->radius = radius;
  return true;
}

}  // namespace

void RayScene::visit_near(
    const glm::dvec3& x_relative, double radius_m,
    const std::function<double(std::uint32_t object, std::uint32_t triangle)>& closer) const {
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  NearVisit visit{closer, std::abs(x_relative.x) + std::abs(x_relative.y) + std::abs(x_relative.z)};
  RTCPointQuery query{float(x_relative.x), float(x_relative.y), float(x_relative.z), 0,
                      safe_radius(radius_m, visit.reach_m)};
  rtcPointQuery(embree_->scene.get(), &query, &context, visit_triangle, &visit);
}

std::uint32_t RayScene::occluded(const RayPacket& given) const {
  RayPacket rays = given;
  prepare(rays);
  return trace_shadows(rays);
}

}  // namespace laterna
