// Synthetic truth: boards in front of a camera and a projector whose rig is known.
#pragma once

#include "calib/boards/rig_rows.h"

#include <cmath>
#include <numbers>
#include <random>

namespace laterna::synthetic {

struct BoardTruth {
  RigModel model;
  BoardRig rig;
  BoardCapture capture;  ///< without noise
};

struct BoardScene {
  int poses = 6;
  double least_tilt = 0.25, most_tilt = 0.7;  ///< rad
  double camera_sigma_px = 0.1, projector_sigma_px = 0.2;
  std::vector<std::string> camera_terms, projector_terms;
  std::vector<double> camera_lens, projector_lens;  ///< parameters of the models of these terms
  glm::dvec2 bend{0.0};
  bool second_camera = false, second_projector = false;  ///< on the other side, the last devices; pinholes
};

/// A rotation that takes direction a to direction b.
inline glm::dmat3 turn(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 axis = glm::cross(glm::normalize(a), glm::normalize(b));
  const double sine = glm::length(axis);
  if (sine < 1e-12) return glm::dmat3(1.0);
  const double angle = std::atan2(sine, glm::dot(glm::normalize(a), glm::normalize(b)));
  return rigid_from_rotation_vector(axis / sine * angle, glm::dvec3(0.0)).rotation;
}

/// A device at a place in the camera's frame that looks with the middle of its image at 1.4 m before it.
inline RigDevice looking_device(std::vector<double> parameters, glm::ivec2 size, const glm::dvec3& position) {
  const glm::dvec3 ray((size.x / 2.0 - parameters[2]) / parameters[0],
                       (size.y / 2.0 - parameters[3]) / parameters[1], 1);
  const glm::dmat3 rotation = turn(glm::dvec3(0, 0, 1.4) - position, ray);
  return {std::move(parameters), {rotation, -(rotation * position)}};
}

/// Camera 1280×1024 at the origin, projector 1024×768 with its principal point below the image, 0.3 m beside.
inline BoardRig rig_without_poses(const BoardScene& scene) {
  BoardRig rig;
  rig.devices.resize(2);
  rig.devices[0].parameters = {1810, 1805, 655, 500};
  rig.devices[1].parameters = {1650, 1655, 500, 860};
  const auto append = [](std::vector<double>& k, const std::vector<double>& lens) {
    k.insert(k.end(), lens.begin(), lens.end());
  };
  append(rig.devices[0].parameters, scene.camera_lens);
  append(rig.devices[1].parameters, scene.projector_lens);
  rig.devices[1] = looking_device(rig.devices[1].parameters, {1024, 768}, {-0.3, 0.15, 0.1});
  if (scene.second_camera)
    rig.devices.push_back(looking_device({1750, 1740, 630, 520}, {1280, 1024}, {0.4, -0.1, 0.05}));
  if (scene.second_projector)
    rig.devices.push_back(looking_device({1600, 1610, 520, 870}, {1024, 768}, {0.35, 0.2, 0.1}));
  rig.bend = scene.bend;
  return rig;
}

/// The board's middle before the camera, tilted about a random axis in the image plane and rolled.
inline Rigid random_board_pose(const BoardScene& scene, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const double about = 2 * std::numbers::pi * uniform(random);
  const double tilt = scene.least_tilt + (scene.most_tilt - scene.least_tilt) * uniform(random);
  const double roll = 0.6 * (uniform(random) - 0.5) + (uniform(random) < 0.5 ? 0 : std::numbers::pi / 2);
  const glm::dmat3 tilted =
      rigid_from_rotation_vector(tilt * glm::dvec3(std::cos(about), std::sin(about), 0), glm::dvec3(0.0))
          .rotation;
  const glm::dmat3 rolled = rigid_from_rotation_vector({0, 0, roll}, glm::dvec3(0.0)).rotation;
  const glm::dvec3 middle(0.3 * (uniform(random) - 0.5), 0.2 * (uniform(random) - 0.5),
                          1.2 + 0.5 * uniform(random));
  return {tilted * rolled, middle - tilted * rolled * glm::dvec3(0.24, 0.18, 0)};
}

inline bool inside(const glm::dvec2& pixel, glm::ivec2 size) {
  return pixel.x > -0.5 && pixel.y > -0.5 && pixel.x < size.x - 0.5 && pixel.y < size.y - 0.5;
}

/// 9×7 corners at 60 mm; a device sees those that fall into its image.
inline BoardTruth board_truth(const BoardScene& scene, std::mt19937_64& random) {
  BoardTruth t;
  t.model.devices = {model_of_terms(scene.camera_terms), model_of_terms(scene.projector_terms)};
  t.rig = rig_without_poses(scene);
  t.capture.devices = {{"camera", {1280, 1024}}, {"projector", {1024, 768}}};
  if (scene.second_camera) t.capture.devices.push_back({"camera2", {1280, 1024}, {}, true});
  if (scene.second_projector) t.capture.devices.push_back({"projector2", {1024, 768}});
  t.model.devices.resize(t.rig.devices.size());
  for (int k = 0; k < scene.poses; ++k) {
    t.rig.camera_from_board.push_back(random_board_pose(scene, random));
    t.capture.pose_labels.push_back(k);
    for (int d = 0; d < int(t.rig.devices.size()); ++d)
      for (int corner = 0; corner < 63; ++corner)
        t.capture.sightings.push_back(
            {d,
             k,
             corner,
             {0.06 * (corner % 9), 0.06 * ((corner - corner % 9) / 9.0), 0},
             {0, 0},
             is_camera(t.capture, d) ? scene.camera_sigma_px : scene.projector_sigma_px});
  }
  t.capture.extent = extent_of(t.capture.sightings);
  const RigProblem problem(t.capture, t.model);
  std::erase_if(t.capture.sightings, [&](Sighting& s) {
    double pixel[2] = {-1e9, -1e9};
    predict(problem, t.rig, s, pixel, nullptr);
    s.pixel = {pixel[0], pixel[1]};
    return !inside(s.pixel, t.capture.devices[s.device].size);
  });
  return t;
}

inline BoardCapture with_noise(BoardCapture capture, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  for (Sighting& s : capture.sightings) s.pixel += s.sigma_px * glm::dvec2(normal(random), normal(random));
  return capture;
}

}  // namespace laterna::synthetic
