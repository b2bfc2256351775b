// Points in front of a camera and a projector in several places, with a known rig.
#pragma once

#include "calib/selfcal/self_calibrate.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <random>

namespace laterna::testing {

inline TrackDevice test_camera() {
  return {"camera", {{1280, 1024}, 1500, 1500, 660, 500}, false, false, false};
}
inline TrackDevice test_projector() {
  return {"projector", {{1024, 768}, 1700, 1700, 512, 700}, false, false, false};
}

struct TrackTruth {
  Tracks tracks;  ///< without noise; sigmas as given
  TrackRig rig;
};

/// A place at `position` that looks at `target`, rolled.
inline Rigid place_at(const glm::dvec3& position, const glm::dvec3& target, double roll = 0) {
  const Rigid looking = device_from_world_looking_at(position, target, {0, -1, 0});
  return compose(rigid_from_rotation_vector({0, 0, roll}, glm::dvec3(0.0)), looking);
}

/// A bumpy scene some 2.2 m away, 0.6 m deep.
inline std::vector<glm::dvec3> bumpy_points(int count, std::mt19937_64& random, double relief = 0.6) {
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  std::vector<glm::dvec3> points;
  for (int i = 0; i < count; ++i) {
    const double x = 1.2 * uniform(random), y = 0.8 * uniform(random);
    points.emplace_back(x, y, 2.2 + relief * uniform(random));
  }
  return points;
}

/// Every point in every station; places are from the first station. The truth has baseline 1 between the
/// first two.
inline TrackTruth track_truth(std::vector<TrackDevice> devices, const std::vector<int>& device_of_station,
                              const std::vector<Rigid>& from_world, const std::vector<glm::dvec3>& points,
                              double sigma_px = 0.1) {
  TrackTruth t;
  t.tracks.devices = std::move(devices);
  t.tracks.has_sigma = true;
  for (std::size_t s = 0; s < from_world.size(); ++s)
    t.tracks.stations.push_back({device_of_station[s], fmt::format("{}", s)});
  for (const TrackDevice& d : t.tracks.devices) {
    t.rig.devices.push_back(d.intrinsics);
    t.rig.lenses.push_back(d.lens.parameters);
  }
  const Rigid world_from_first = inverse(from_world[0]);
  for (const Rigid& place : from_world) t.rig.station_from_first.push_back(compose(place, world_from_first));
  const TrackColumns columns = columns_of(t.tracks);
  for (const glm::dvec3& x_world : points) {
    const glm::dvec3 x = apply(from_world[0], x_world);
    t.rig.points.push_back(x);
    const int p = t.tracks.point_count();
    t.tracks.point_names.push_back(fmt::format("{}", p));
    for (int s = 0; s < t.tracks.station_count(); ++s)
      if (const auto pixel = predict(t.tracks, columns, t.rig, s, x))
        t.tracks.sightings.push_back({p, s, *pixel, sigma_px});
  }
  return t;
}

/// Makes a device unknown: what is named is free, and starts from nothing but the middle of the image.
inline void forget(Tracks& tracks, int device, bool center, bool aspect = false) {
  TrackDevice& d = tracks.devices[device];
  d.focal = true, d.center = center, d.aspect = aspect;
  d.intrinsics.fx = d.intrinsics.fy = 0;
  if (center)
    d.intrinsics.cx = (d.intrinsics.size.x - 1) / 2.0, d.intrinsics.cy = (d.intrinsics.size.y - 1) / 2.0;
}

inline void add_noise(Tracks& tracks, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  for (TrackSighting& s : tracks.sightings) {
    const double du = normal(random);
    s.pixel += s.sigma_px * glm::dvec2(du, normal(random));
  }
}

/// Camera at the origin, projector beside it, aimed so that the optical axes miss each other.
inline TrackTruth one_pair(std::mt19937_64& random, int points = 200, double sigma_px = 0.1) {
  return track_truth({test_camera(), test_projector()}, {0, 1},
                     {place_at({0, 0, 0}, {0.02, 0.25, 2.2}), place_at({0.7, 0.1, 0.2}, {0, -0.2, 2.2}, 0.1)},
                     bumpy_points(points, random), sigma_px);
}

/// The same camera, the projector in three places around the scene.
inline TrackTruth three_places(std::mt19937_64& random, int points = 200, double sigma_px = 0.1) {
  return track_truth(
      {test_camera(), test_projector()}, {0, 1, 1, 1},
      {place_at({0, 0, 0}, {0, 0, 2.2}), place_at({0.8, 0.1, 0.2}, {0, -0.3, 2.2}, 0.1),
       place_at({-0.7, -0.5, 0}, {0.1, -0.2, 2.3}, 1.3), place_at({0.2, 0.7, 0.3}, {0, -0.2, 2.1}, -0.6)},
      bumpy_points(points, random), sigma_px);
}

/// The global step from a truth to an estimate, the truth scaled to the estimate's unit baseline.
inline std::vector<double> error_step(const SelfCalibration& c, const TrackRig& truth) {
  const auto& [a, b] = c.units.front();
  const double scale = 1 / glm::length(center_in_world(truth.station_from_first[b]) -
                                       center_in_world(truth.station_from_first[a]));
  const TrackColumns columns = columns_of(c.tracks);
  std::vector<double> step(columns.count, 0.0);
  for (std::size_t d = 0; d < truth.devices.size(); ++d) {
    const Intrinsics &k = c.rig.devices[d], &t = truth.devices[d];
    const double by[4] = {k.fx - t.fx, k.fy - t.fy, k.cx - t.cx, k.cy - t.cy};
    for (int i = 0; i < 4; ++i)
      if (columns.intrinsics[d][i] >= 0) step[columns.intrinsics[d][i]] = by[i];
    for (std::size_t i = 0; i < truth.lenses[d].size(); ++i)
      if (const int at = columns.intrinsics[d][4 + i]; at >= 0)
        step[at] = c.rig.lenses[d][i] - truth.lenses[d][i];
  }
  for (std::size_t s = 1; s < truth.station_from_first.size(); ++s) {
    const Rigid &k = c.rig.station_from_first[s], &t = truth.station_from_first[s];
    const glm::dvec3 w = rotation_vector_rad(k.rotation * glm::transpose(t.rotation));
    const glm::dvec3 d = k.translation - scale * t.translation;
    for (int i = 0; i < 3; ++i) step[columns.station[s] + i] = w[i], step[columns.station[s] + 3 + i] = d[i];
  }
  return step;
}

}  // namespace laterna::testing
