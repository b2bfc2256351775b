#include "tests/lab/score/random_rigs.h"

#include "calib/solve.h"
#include "sim/formats/laterna_rig.h"
#include "tests/testing.h"

#include <array>
#include <cmath>

namespace laterna::testing {

namespace {

double log_uniform(std::mt19937_64& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

glm::dvec3 any_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

Intrinsics random_intrinsics(std::mt19937_64& random) {
  static constexpr std::array<glm::ivec2, 8> sizes{{{1920, 1080},
                                                    {1280, 800},
                                                    {1024, 768},
                                                    {800, 600},
                                                    {1024, 1024},
                                                    {1080, 1920},
                                                    {854, 480},
                                                    {320, 200}}};
  const glm::dvec2 size(sizes[one_of(random, sizes.size())]);
  Intrinsics k{glm::ivec2(size)};
  k.fx = uniform(random, 0.8, 2.2) * std::max(size.x, size.y);
  k.fy = k.fx * (one_of(random, 3) == 0 ? 1 : uniform(random, 0.995, 1.005));
  const std::size_t centre = one_of(random, 5);
  glm::dvec2 shift(0.0);
  if (centre > 0) shift = {uniform(random, -0.04, 0.04), uniform(random, -0.04, 0.04)};
  if (centre > 2) shift.y += (centre == 3 ? 1 : -1) * uniform(random, 0.35, 0.6);
  k.cx = (size.x - 1) / 2 + shift.x * size.x;
  k.cy = (size.y - 1) / 2 + shift.y * size.y;
  return k;
}

Lens random_lens(std::mt19937_64& random) {
  const double k1 = uniform(random, -0.06, 0.06), k2 = uniform(random, -0.02, 0.02);
  const double p1 = uniform(random, -0.002, 0.002), p2 = uniform(random, -0.002, 0.002);
  const std::size_t kind = one_of(random, 4);
  if (kind == 0) return {"LENSMODEL_OPENCV4", {k1, k2, p1, p2}};
  if (kind == 1) return {"LENSMODEL_OPENCV5", {k1, k2, p1, p2, uniform(random, -0.01, 0.01)}};
  return {};
}

}  // namespace

double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

std::size_t one_of(std::mt19937_64& random, std::size_t count) {
  return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

Correspondences points_before(const Device& projector, double distance_m, double relief, std::size_t count,
                              std::mt19937_64& random) {
  Correspondences c;
  const WorldProjection projection(projector);
  const glm::dvec2 size(projector.intrinsics.size);
  const double waves = uniform(random, 2, 6), phase = uniform(random, 0, 6);
  while (c.world_points.size() < count) {
    const glm::dvec2 share(uniform(random, 0, 1), uniform(random, 0, 1));
    const double height = std::sin(waves * share.x + phase) * std::cos(waves * share.y - phase);
    const glm::dvec2 pixel = share * size - 0.5;
    const auto x = projection.unproject(pixel, distance_m * (1 + relief / 2 * height));
    if (!x) continue;
    c.world_points.push_back(*x);
    c.projector_pixels.push_back(pixel);
  }
  return c;
}

namespace {

// Devices at random, and how far away the surface is.
double draw_devices(CalibratedRig& rig, std::mt19937_64& random) {
  rig.projector = {"projector", random_intrinsics(random), {}, random_lens(random), {}};
  const double distance = log_uniform(random, 0.4, 12);
  const bool is_turned = one_of(random, 2) == 0;
  const double angle = is_turned ? uniform(random, 0.5, 3) : uniform(random, 0.02, 0.3);
  rig.projector.device_from_world = rigid_from_rotation_vector(
      angle * any_direction(random), distance * uniform(random, 0.1, 1.5) * any_direction(random));
  const glm::dvec3 centre_world = center_in_world(rig.projector.device_from_world);
  const glm::dvec3 target_world =
      inverse(rig.projector.device_from_world).rotation[2] * distance + centre_world;
  const glm::dvec3 camera_world = centre_world + distance * uniform(random, 0.1, 0.6) * any_direction(random);
  rig.camera = {"camera", intrinsics_from_fov_x({1280, 800}, 0.7, 1.6), {}, {}, {}};
  rig.camera.device_from_world =
      device_from_world_looking_at(camera_world, target_world, any_direction(random));
  return distance;
}

// Those of a scene that ships; the surface is two baselines away.
double take_devices(const char* scene, CalibratedRig& rig) {
  const Rig devices = read_scene_rig(data_folder() / "scenes" / scene);
  rig.projector = devices.projectors.at(0), rig.camera = devices.cameras.at(0);
  rig.projector.name = "projector", rig.camera.name = "camera";
  return 2 * glm::distance(center_in_world(rig.projector.device_from_world),
                           center_in_world(rig.camera.device_from_world));
}

}  // namespace

CalibratedRig random_rig(std::mt19937_64& random) {
  static constexpr const char* scenes[] = {"board.toml",  "dragon.toml", "house.toml",   "near_focus.toml",
                                           "relief.toml", "rig.toml",    "v_groove.toml"};
  std::normal_distribution<double> normal;
  for (;;) {
    CalibratedRig rig;
    const bool ships = one_of(random, 4) == 0;
    const double distance =
        ships ? take_devices(scenes[one_of(random, std::size(scenes))], rig) : draw_devices(rig, random);
    rig.seen = points_before(rig.projector, distance, uniform(random, 0.05, 0.5), 1500, random);
    const double sigma_px = log_uniform(random, 0.02, 0.4);
    rig.seen.sigma_px.assign(rig.seen.world_points.size(), sigma_px);
    Correspondences noisy = rig.seen;
    for (glm::dvec2& p : noisy.projector_pixels) p += sigma_px * glm::dvec2(normal(random), normal(random));
    SolveOptions options;
    options.lens_model = rig.projector.lens.model;
    const SolveResult solved = solve(noisy, rig.projector.intrinsics.size, options);
    if (solved.status != Status::ok) continue;  // a drawn lens that folds, or noise too large for the relief
    rig.recovered = solved.estimate;
    rig.recovered.name = rig.projector.name;
    rig.bound_px = solved.predicted_volume_rms_px;
    return rig;
  }
}

Rig right_result(const CalibratedRig& rig, bool in_camera_frame) {
  Rig result{{rig.camera}, {rig.recovered}};
  if (!in_camera_frame) return result;
  const Rigid world_from_camera = inverse(rig.camera.device_from_world);
  for (Device* device : {&result.cameras[0], &result.projectors[0]})
    device->device_from_world = compose(device->device_from_world, world_from_camera);
  result.cameras[0].device_from_world = Rigid{};
  return result;
}

}  // namespace laterna::testing
