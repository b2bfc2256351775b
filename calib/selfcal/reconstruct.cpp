#include "calib/selfcal/reconstruct.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

namespace laterna {

namespace {

using Matrix3 = Eigen::Matrix3d;

Matrix3 to_eigen(const glm::dmat3& g) {
  Matrix3 m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = g[j][i];
  return m;
}

Rigid rigid_of(const Matrix3& r, const Eigen::Vector3d& t) {
  Rigid rigid;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rigid.rotation[j][i] = r(i, j);
  rigid.translation = {t.x(), t.y(), t.z()};
  return rigid;
}

Matrix3 matrix_of(const Intrinsics& k) {
  Matrix3 m;
  m << k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1;
  return m;
}

glm::dvec2 ray_of(const Intrinsics& k, const glm::dvec2& pixel) {
  return {(pixel.x - k.cx) / k.fx, (pixel.y - k.cy) / k.fy};
}

const Intrinsics& of_station(const Tracks& tracks, const std::vector<Intrinsics>& devices, int s) {
  return devices[tracks.stations[s].device];
}

struct Ray {
  const Rigid* place;
  glm::dvec2 at;  // x/z, y/z
};

// Linear triangulation (Hartley and Zisserman, 12.2); none where it lies behind, or at infinity.
std::optional<glm::dvec3> triangulate(const std::vector<Ray>& rays) {
  Eigen::MatrixXd a(2 * Eigen::Index(rays.size()), 4);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Eigen::Matrix<double, 3, 4> p;
    p.leftCols<3>() = to_eigen(rays[i].place->rotation);
    for (int k = 0; k < 3; ++k) p(k, 3) = rays[i].place->translation[k];
    a.row(2 * i) = rays[i].at.x * p.row(2) - p.row(0);
    a.row(2 * i + 1) = rays[i].at.y * p.row(2) - p.row(1);
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeFullV);
  const Eigen::Vector4d h = svd.matrixV().col(3);
  const glm::dvec3 x(h[0] / h[3], h[1] / h[3], h[2] / h[3]);
  if (!(glm::length(x) < 1e6)) return std::nullopt;
  for (const Ray& ray : rays)
    if (!(apply(*ray.place, x).z > 0)) return std::nullopt;
  return x;
}

// b_from_a with a baseline of 1: the one of four in which most points lie in front of both.
std::optional<Rigid> relative_place(const SolvedPair& p, const Intrinsics& a, const Intrinsics& b) {
  const Matrix3 e = matrix_of(b).transpose() * to_eigen(p.geometry.fundamental) * matrix_of(a);
  const Eigen::JacobiSVD<Matrix3> svd(e, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 u = svd.matrixU(), v = svd.matrixV(), w;
  if (u.determinant() < 0) u.col(2) *= -1;
  if (v.determinant() < 0) v.col(2) *= -1;
  w << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const std::size_t step = std::max<std::size_t>(1, p.pair.size() / 200);
  std::size_t most = 0;
  std::optional<Rigid> best;
  for (const Matrix3& r : {Matrix3(u * w * v.transpose()), Matrix3(u * w.transpose() * v.transpose())}) {
    for (const double sign : {1.0, -1.0}) {
      const Rigid identity, place = rigid_of(r, sign * u.col(2));
      std::size_t front = 0;
      for (std::size_t i = 0; i < p.pair.size(); i += step)
        front +=
            triangulate({{&identity, ray_of(a, p.pair.pixel_a[i])}, {&place, ray_of(b, p.pair.pixel_b[i])}})
                .has_value();
      if (front > most) most = front, best = place;
    }
  }
  return best;
}

// The place of a station from placed points; none below 6 of them.
std::optional<Rigid> resection(const Tracks& tracks, const TrackRig& rig, int station) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const TrackSighting& s : tracks.sightings) {
    if (s.station != station || !rig.has_point(s.point)) continue;
    const glm::dvec3& x = rig.points[s.point];
    points.emplace_back(x.x, x.y, x.z), pixels.emplace_back(s.pixel.x, s.pixel.y);
  }
  if (points.size() < 6) return std::nullopt;
  const Intrinsics& k = of_station(tracks, rig.devices, station);
  const cv::Mat matrix = (cv::Mat_<double>(3, 3) << k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1);
  cv::Mat rotation, translation;
  const float reach = float(std::max(8.0, k.fx / 50));  // the intrinsics are guesses
  try {
    if (!cv::solvePnPRansac(points, pixels, matrix, cv::noArray(), rotation, translation, false, 300, reach))
      return std::nullopt;
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  const auto r = rotation.ptr<double>(), t = translation.ptr<double>();
  if (!std::isfinite(r[0] + r[1] + r[2] + t[0] + t[1] + t[2])) return std::nullopt;
  return rigid_from_rotation_vector({r[0], r[1], r[2]}, {t[0], t[1], t[2]});
}

// Points seen from two or more placed stations and not placed yet.
void triangulate_missing(const Tracks& tracks, const std::vector<char>& placed, TrackRig& rig) {
  std::vector<Ray> rays;
  std::vector<LensProjection> lenses;
  for (std::size_t d = 0; d < rig.devices.size(); ++d)
    lenses.emplace_back(rig.devices[d], Lens{tracks.devices[d].lens.model, rig.lenses[d]});
  for (std::size_t i = 0; i < tracks.sightings.size(); ++i) {
    const TrackSighting& s = tracks.sightings[i];
    if (i == 0 || tracks.sightings[i - 1].point != s.point) rays.clear();
    if (placed[s.station])
      if (const auto ray = lenses[tracks.stations[s.station].device].unproject(s.pixel))
        rays.push_back({&rig.station_from_first[s.station], glm::dvec2(*ray) / ray->z});
    const bool last = i + 1 == tracks.sightings.size() || tracks.sightings[i + 1].point != s.point;
    if (!last || rays.size() < 2 || rig.has_point(s.point)) continue;
    if (const auto x = triangulate(rays)) rig.points[s.point] = *x;
  }
}

// Points that some placed station has behind it are not placed.
void drop_points_behind(const Tracks& tracks, const std::vector<char>& placed, TrackRig& rig) {
  for (const TrackSighting& s : tracks.sightings)
    if (placed[s.station] && rig.has_point(s.point) &&
        !(apply(rig.station_from_first[s.station], rig.points[s.point]).z > 0))
      rig.points[s.point] = glm::dvec3(NAN);
}

// Stations are placed in the frame of the strongest pair's first; this makes it that of station 0.
void refer_to_first(TrackRig& rig) {
  const Rigid first = rig.station_from_first.front(), back = inverse(first);
  for (Rigid& place : rig.station_from_first) place = compose(place, back);
  rig.station_from_first.front() = {};
  for (glm::dvec3& x : rig.points) x = apply(first, x);
}

bool place_next(const std::vector<SolvedPair>& pairs, const Tracks& tracks, std::vector<char>& placed,
                Reconstruction& r) {
  std::vector<std::pair<int, int>> known;  // placed points that a station sees, station
  for (int s = 0; s < tracks.station_count(); ++s) known.emplace_back(0, s);
  for (const TrackSighting& s : tracks.sightings) known[s.station].first += r.rig.has_point(s.point);
  std::stable_sort(known.begin(), known.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [count, s] : known) {
    if (placed[s]) continue;
    if (const auto place = resection(tracks, r.rig, s)) {
      r.rig.station_from_first[s] = *place;
      placed[s] = 1;
      return true;
    }
  }
  for (const SolvedPair& p : pairs) {
    const auto [a, b] = std::pair(p.pair.a, p.pair.b);
    if (placed[a] == placed[b]) continue;
    const auto b_from_a =
        relative_place(p, of_station(tracks, r.rig.devices, a), of_station(tracks, r.rig.devices, b));
    if (!b_from_a) continue;
    auto& places = r.rig.station_from_first;
    (placed[a] ? places[b] : places[a]) =
        placed[a] ? compose(*b_from_a, places[a]) : compose(inverse(*b_from_a), places[b]);
    r.units.emplace_back(a, b);
    placed[a] = placed[b] = 1;
    return true;
  }
  return false;
}

std::vector<double> focal_guesses(const TrackDevice& d) {
  std::vector<double> f;
  for (double ratio = 0.4; ratio < 6.1; ratio *= 1.25) f.push_back(ratio * d.intrinsics.size.x);
  return f;
}

std::vector<Intrinsics> device_guesses(const TrackDevice& d, const std::vector<double>& more_focals) {
  if (d.free_count() == 0) return {d.intrinsics};
  std::vector<double> focals = focal_guesses(d);
  focals.insert(focals.end(), more_focals.begin(), more_focals.end());
  std::vector<Intrinsics> guesses;
  for (const double f : focals)
    for (const double shift : {0.0, 0.5, -0.5}) {
      Intrinsics k = d.intrinsics;
      k.fx = k.fy = f;
      k.cy += shift * k.size.y;
      if (shift == 0 || d.center) guesses.push_back(k);
    }
  return guesses;
}

// Guesses that lead to one place: every f within 30 % and every centre within a quarter of the image.
bool alike(const std::vector<Intrinsics>& a, const std::vector<Intrinsics>& b) {
  for (std::size_t d = 0; d < a.size(); ++d)
    if (std::abs(std::log(a[d].fx / b[d].fx)) > 0.26 || std::abs(a[d].cy - b[d].cy) > 0.25 * a[d].size.y)
      return false;
  return true;
}

}  // namespace

const SolvedPair& strongest_pair(const std::vector<SolvedPair>& pairs) {
  const auto score = [](const SolvedPair& p) {
    return std::sqrt(double(p.pair.size())) * std::min(p.geometry.homography_scale, 1e9);
  };
  return *std::max_element(pairs.begin(), pairs.end(),
                           [&](const auto& a, const auto& b) { return score(a) < score(b); });
}

double essential_misfit(const std::vector<SolvedPair>& pairs, const Tracks& tracks,
                        const std::vector<Intrinsics>& devices) {
  double sum = 0;
  for (const SolvedPair& p : pairs) {
    const Matrix3 e = matrix_of(of_station(tracks, devices, p.pair.b)).transpose() *
                      to_eigen(p.geometry.fundamental) * matrix_of(of_station(tracks, devices, p.pair.a));
    const Eigen::Vector3d s = Eigen::JacobiSVD<Matrix3>(e).singularValues();
    sum += std::pow((s[0] - s[1]) / (s[0] + s[1]), 2);
  }
  return std::sqrt(sum / double(pairs.size()));
}

std::vector<std::vector<Intrinsics>> intrinsics_guesses(const std::vector<SolvedPair>& pairs,
                                                        const Tracks& tracks, std::size_t most) {
  std::vector<std::vector<double>> closed(tracks.devices.size());
  for (const SolvedPair& p : pairs) {
    const int a = tracks.stations[p.pair.a].device, b = tracks.stations[p.pair.b].device;
    const Intrinsics &ka = tracks.devices[a].intrinsics, &kb = tracks.devices[b].intrinsics;
    const auto f = squared_focal_lengths(p.geometry.fundamental, {ka.cx, ka.cy}, {kb.cx, kb.cy});
    for (const auto& [device, squared] : {std::pair(a, f[0]), std::pair(b, f[1])}) {
      const double ratio = std::sqrt(squared) / tracks.devices[device].intrinsics.size.x;
      if (ratio > 0.2 && ratio < 20 && closed[device].size() < 3)
        closed[device].push_back(std::sqrt(squared));
    }
  }
  std::vector<std::vector<Intrinsics>> all{{}};
  for (std::size_t d = 0; d < tracks.devices.size(); ++d) {
    std::vector<std::vector<Intrinsics>> longer;
    for (const auto& head : all)
      for (const Intrinsics& k : device_guesses(tracks.devices[d], closed[d])) {
        longer.push_back(head);
        longer.back().push_back(k);
      }
    all = std::move(longer);
  }
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < all.size(); ++i) order.emplace_back(essential_misfit(pairs, tracks, all[i]), i);
  std::sort(order.begin(), order.end());
  std::vector<std::vector<Intrinsics>> best;
  for (std::size_t i = 0; i < order.size() && best.size() < most; ++i) {
    const auto& guess = all[order[i].second];
    if (std::none_of(best.begin(), best.end(), [&](const auto& b) { return alike(b, guess); }))
      best.push_back(guess);
  }
  return best;
}

std::optional<Reconstruction> reconstruct(const std::vector<SolvedPair>& pairs, const Tracks& tracks,
                                          const std::vector<Intrinsics>& devices) {
  const SolvedPair& first = strongest_pair(pairs);
  const auto place = relative_place(first, of_station(tracks, devices, first.pair.a),
                                    of_station(tracks, devices, first.pair.b));
  if (!place) return std::nullopt;
  std::vector<std::vector<double>> lenses;
  for (const TrackDevice& d : tracks.devices) lenses.push_back(d.lens.parameters);
  Reconstruction r{{devices, std::vector<Rigid>(tracks.stations.size()),
                    std::vector<glm::dvec3>(tracks.point_names.size(), glm::dvec3(NAN)), lenses},
                   {{first.pair.a, first.pair.b}}};
  std::vector<char> placed(tracks.stations.size(), 0);
  r.rig.station_from_first[first.pair.b] = *place;
  placed[first.pair.a] = placed[first.pair.b] = 1;
  triangulate_missing(tracks, placed, r.rig);
  while (std::count(placed.begin(), placed.end(), 0) > 0) {
    if (!place_next(pairs, tracks, placed, r)) return std::nullopt;
    drop_points_behind(tracks, placed, r.rig);
    triangulate_missing(tracks, placed, r.rig);
  }
  refer_to_first(r.rig);
  return r;
}

void place_missing_points(const Tracks& tracks, TrackRig& rig) {
  triangulate_missing(tracks, std::vector<char>(tracks.stations.size(), 1), rig);
}

}  // namespace laterna
