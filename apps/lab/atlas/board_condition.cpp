#include "apps/lab/atlas/board_condition.h"

#include "calib/boards/rig_covariance.h"
#include "calib/verify.h"

#include <cmath>
#include <numbers>

namespace laterna {

namespace {

// From pose `to`, the share `alike` of the way to pose `from`.
Rigid towards(const Rigid& to, const Rigid& from, double alike) {
  const glm::dquat q = glm::slerp(glm::quat_cast(to.rotation), glm::quat_cast(from.rotation), alike);
  return {glm::mat3_cast(glm::normalize(q)), glm::mix(to.translation, from.translation, alike)};
}

// The sightings again, from rig and poses as they are now.
void sight_again(synthetic::BoardTruth& t) {
  const RigProblem problem(t.capture, t.model);
  std::erase_if(t.capture.sightings, [&](Sighting& s) {
    double pixel[2] = {-1e9, -1e9};
    if (!predict(problem, t.rig, s, pixel, nullptr)) return true;
    s.pixel = {pixel[0], pixel[1]};
    return !synthetic::inside(s.pixel, t.capture.devices[std::size_t(s.device)].size);
  });
}

std::vector<glm::dvec3> projector_volume(const BoardProblem& problem) {
  Device device = device_of(problem.truth.rig, problem.truth.model, problem.truth.capture, 1);
  std::vector<double> depths;
  for (const Sighting& s : problem.truth.capture.sightings) {
    if (s.device != 1) continue;
    const glm::dvec3 x = apply(problem.truth.rig.camera_from_board[std::size_t(s.pose)], s.x_board);
    depths.push_back(apply(device.device_from_world, x).z);
  }
  device.device_from_world = {};
  return depths.empty() ? std::vector<glm::dvec3>{} : image_grid(device, volume_depths(depths));
}

}  // namespace

BoardProblem board_problem(const BoardCondition& c, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  synthetic::BoardScene scene;
  scene.poses = c.poses;
  scene.least_tilt = glm::radians(c.least_tilt_deg), scene.most_tilt = glm::radians(c.most_tilt_deg);
  scene.camera_sigma_px = c.camera_noise_px, scene.projector_sigma_px = c.projector_noise_px;
  if (c.camera_k1 != 0) scene.camera_terms = {"k1"}, scene.camera_lens = {c.camera_k1, 0, 0, 0};
  if (c.projector_k1 != 0) scene.projector_terms = {"k1"}, scene.projector_lens = {c.projector_k1, 0, 0, 0};
  scene.bend = {c.bend_m, 0.5 * c.bend_m};
  BoardProblem problem{synthetic::board_truth(scene, random), {}};
  problem.truth.model.bend = c.bend_m != 0;
  std::vector<Rigid>& poses = problem.truth.rig.camera_from_board;
  if (c.alike > 0) {
    for (std::size_t k = 1; k < poses.size(); ++k) poses[k] = towards(poses[k], poses[0], c.alike);
    sight_again(problem.truth);
  }
  problem.capture = synthetic::with_noise(problem.truth.capture, random);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (Sighting& s : problem.capture.sightings)
    if (uniform(random) < c.outliers)
      s.pixel += glm::dvec2(60 * uniform(random) - 30, 60 * uniform(random) - 30);
  return problem;
}

double board_volume_error_px(const BoardProblem& problem, const RigModel& model, const BoardRig& rig,
                             const std::vector<int>& poses) {
  const LensGradient lens(model.devices[1].lens_model);
  const std::vector<glm::dvec3> volume = projector_volume(problem);
  const WorldProjection projection([&] {
    Device device = device_of(problem.truth.rig, problem.truth.model, problem.truth.capture, 1);
    device.device_from_world = {};
    return device;
  }());
  double sum = 0;
  for (const glm::dvec3& x : volume) {
    const auto carried = carried_pixel(lens, problem.truth.rig, rig, poses, 1, x);
    if (!carried) return INFINITY;
    const glm::dvec2 d = *carried - glm::dvec2(projection.project(x));
    sum += glm::dot(d, d);
  }
  return volume.empty() ? NAN : std::sqrt(sum / double(volume.size()));
}

double board_volume_bound_px(const BoardProblem& problem) {
  const RigProblem rows(problem.truth.capture, problem.truth.model);
  const auto at_truth = adjust(rows, problem.truth.rig);
  const auto covariance = at_truth ? rig_covariance(rows, *at_truth) : std::nullopt;
  const std::vector<glm::dvec3> volume = projector_volume(problem);
  if (!covariance || volume.empty()) return NAN;
  double sum = 0;
  for (const glm::dvec3& x : volume) {
    const auto c = pixel_covariance(rows, problem.truth.rig, *covariance, 1, x);
    if (!c) return NAN;
    sum += c->x + c->z;
  }
  return std::sqrt(sum / double(volume.size()));
}

}  // namespace laterna
