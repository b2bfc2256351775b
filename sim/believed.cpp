#include "sim/believed.h"

#include "sim/decimate.h"
#include "sim/smooth_normals.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

namespace laterna {

namespace {

// Rz·Ry·Rx, as MeshSpec turns meshes.
glm::dmat4 turned(const glm::dvec3& rotate_deg) {
  const glm::dvec3 turn = glm::radians(rotate_deg);
  glm::dmat4 m = glm::rotate(glm::dmat4(1.0), turn.z, glm::dvec3(0, 0, 1));
  m = glm::rotate(m, turn.y, glm::dvec3(0, 1, 0));
  return glm::rotate(m, turn.x, glm::dvec3(1, 0, 0));
}

// Moves each vertex along its normal in the world; a step s there is A⁻¹·s in the object, A the linear part
// of world_from_object, and a normal n is A⁻ᵀ·n in the world.
void add_noise(Mesh& mesh, const glm::dmat4& world_from_object, double sigma_m, std::uint64_t seed) {
  const glm::dmat3 object_from_world = glm::inverse(glm::dmat3(world_from_object));
  const std::vector<glm::dvec3> normals = smooth_normals(mesh, first_of_position(mesh));
  std::mt19937_64 random(seed);
  std::normal_distribution<double> deviate;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const double step_m = sigma_m * deviate(random);
    const glm::dvec3 normal_world = glm::transpose(object_from_world) * normals[i];
    const double length = glm::length(normal_world);
    if (length > 0) mesh.positions[i] += object_from_world * (step_m / length * normal_world);
  }
}

}  // namespace

bool believed_otherwise(const Scene& scene, const Object& object) {
  MeshBelief seeded;
  seeded.seed = object.belief.seed;
  return !scene.believe_truth && !(object.belief == seeded);
}

bool believed_otherwise(const Scene& scene, const Camera& camera) {
  const CameraBelief& b = camera.belief;
  const glm::dvec3 none(0.0);
  return !scene.believe_truth && (b.rotate_deg != none || b.translate != none ||
                                  b.focal_px != glm::dvec2(0.0) || b.center_px != glm::dvec2(0.0));
}

Object believed(const Object& object) {
  const MeshBelief& belief = object.belief;
  Object result{.name = object.name, .mesh = {}, .world_from_object = {}, .albedo_map = {}};
  result.mesh = welded(object.believed_mesh ? *object.believed_mesh : object.mesh);
  if (belief.keep < 1) result.mesh = decimated(result.mesh, belief.keep);
  if (belief.noise_sigma_m > 0)
    add_noise(result.mesh, object.world_from_object, belief.noise_sigma_m, belief.seed);
  const glm::dvec3 origin(object.world_from_object[3]);
  const glm::dmat4 there = glm::translate(glm::dmat4(1.0), origin + belief.translate);
  const glm::dmat4 enlarged = glm::scale(turned(belief.rotate_deg), glm::dvec3(belief.scale));
  result.world_from_object =
      there * enlarged * glm::translate(glm::dmat4(1.0), -origin) * object.world_from_object;
  return result;
}

Device believed_device(const Camera& camera) {
  const CameraBelief& belief = camera.belief;
  Device device = camera.device;
  Intrinsics& k = device.intrinsics;
  k.fx += belief.focal_px.x, k.fy += belief.focal_px.y;
  k.cx += belief.center_px.x, k.cy += belief.center_px.y;
  device.device_from_world =
      compose({glm::dmat3(turned(belief.rotate_deg)), belief.translate}, camera.device.device_from_world);
  validate(device);
  return device;
}

const Scene& believed(const Scene& scene, std::optional<Scene>& storage) {
  const auto differs = [&](const auto& noun) { return believed_otherwise(scene, noun); };
  if (std::none_of(scene.objects.begin(), scene.objects.end(), differs) &&
      std::none_of(scene.cameras.begin(), scene.cameras.end(), differs))
    return scene;
  storage = scene;
  for (Object& object : storage->objects)
    if (differs(object)) object = believed(object);
  for (Camera& camera : storage->cameras)
    if (differs(camera)) camera.device = believed_device(camera);
  return *storage;
}

std::vector<double> told_covariance(const Scene& scene, const Camera& camera) {
  const CameraBelief& b = camera.belief;
  std::vector<double> sigma{b.sigma_focal_px.x, b.sigma_focal_px.y, b.sigma_center_px.x, b.sigma_center_px.y};
  sigma.resize(4 + camera.device.lens.parameters.size(), 0.0);
  const glm::dvec3 turn = glm::radians(b.sigma_rotate_deg), &move = b.sigma_translate;
  sigma.insert(sigma.end(), {turn.x, turn.y, turn.z, move.x, move.y, move.z});
  if (scene.believe_truth || std::all_of(sigma.begin(), sigma.end(), [](double s) { return s == 0; }))
    return {};
  const std::size_t p = sigma.size(), w = p - 6, t = p - 3;  // first of rotation, of translation
  std::vector<std::vector<double>> steps(p, std::vector<double>(p, 0.0));  // what each sigma alone does
  for (std::size_t i = 0; i < p; ++i) steps[i][i] = sigma[i];
  const glm::dmat3 axes(1.0);
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 moved =
        glm::cross(axes[i] * turn[i], believed_device(camera).device_from_world.translation);
    for (int j = 0; j < 3; ++j) steps[w + i][t + j] = moved[j];
  }
  std::vector<double> covariance(p * p, 0.0);
  for (const std::vector<double>& step : steps)
    for (std::size_t i = 0; i < p; ++i)
      for (std::size_t j = 0; j < p; ++j) covariance[i * p + j] += step[i] * step[j];
  return covariance;
}

}  // namespace laterna
