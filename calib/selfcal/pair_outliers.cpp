#include "calib/selfcal/pair_outliers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace laterna {

namespace {

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / std::max(1.0, double(values.size())));
}

double median_abs(std::vector<double> values) {
  for (double& v : values) v = std::abs(v);
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

// The 1 - 1e-5 quantile of χ² (Wilson and Hilferty 1931).
double chi2_limit(int dof) {
  const double a = 2.0 / (9.0 * dof);
  return dof * std::pow(1 - a + 4.265 * std::sqrt(a), 3);
}

std::vector<SolvedPair> solve(const Tracks& tracks) {
  std::vector<SolvedPair> solved;
  for (StationPair& pair : station_pairs(tracks)) {
    PairGeometry geometry = pair_geometry(pair);
    solved.push_back({std::move(pair), std::move(geometry)});
  }
  return solved;
}

// The pixels of the points that two stations share are the same.
bool same_pixels(const StationPair& p) {
  std::vector<double> r;
  for (std::size_t i = 0; i < p.size(); ++i)
    r.push_back(glm::length(p.pixel_a[i] - p.pixel_b[i]) /
                std::sqrt(2 * (p.sigma_a[i] * p.sigma_a[i] + p.sigma_b[i] * p.sigma_b[i])));
  return 1.4826 * median_abs(r) < 2;
}

// Pair q of the stations (c, y) obeys the geometry of pair p of (c, x), x and y placements of one device.
bool same_geometry(const SolvedPair& p, const SolvedPair& q, int common) {
  if ((p.pair.a == common) != (q.pair.a == common)) return false;  // device order by station order
  const StationPair good = kept(q.pair, q.geometry.inlier);
  return rms(epipolar_residuals(good, p.geometry.fundamental)) <
         2 * std::max({1.0, p.geometry.epipolar_scale, q.geometry.epipolar_scale});
}

bool same_station(const std::vector<SolvedPair>& pairs, int x, int y) {
  for (const SolvedPair& p : pairs)
    if (p.pair.a == x && p.pair.b == y) return same_pixels(p.pair);
  for (const SolvedPair& p : pairs)
    for (const SolvedPair& q : pairs)
      for (const int common : {p.pair.a, p.pair.b}) {
        const int of_p = p.pair.a + p.pair.b - common, of_q = q.pair.a + q.pair.b - common;
        if ((q.pair.a == common || q.pair.b == common) && of_p == x && of_q == y)
          return same_geometry(p, q, common);
      }
  return false;
}

// Station y becomes x.
void merge(Tracks& tracks, int x, int y) {
  for (TrackSighting& s : tracks.sightings) {
    if (s.station == y) s.station = x;
    if (s.station > y) --s.station;
  }
  tracks.stations.erase(tracks.stations.begin() + y);
  const auto key = [](const TrackSighting& s) { return std::pair(s.point, s.station); };
  std::stable_sort(tracks.sightings.begin(), tracks.sightings.end(),
                   [&](const auto& a, const auto& b) { return key(a) < key(b); });
  const auto end = std::unique(tracks.sightings.begin(), tracks.sightings.end(),
                               [&](const auto& a, const auto& b) { return key(a) == key(b); });
  tracks.sightings.erase(end, tracks.sightings.end());
}

template <class Residual>
std::vector<DroppedSighting> drop(Tracks& tracks, const std::vector<char>& gone, Residual&& residual) {
  std::vector<DroppedSighting> dropped;
  std::vector<TrackSighting> left;
  for (std::size_t i = 0; i < gone.size(); ++i) {
    if (gone[i])
      dropped.push_back({tracks.sightings[i], residual(i)});
    else
      left.push_back(tracks.sightings[i]);
  }
  tracks.sightings = std::move(left);
  return dropped;
}

}  // namespace

std::vector<SolvedPair> solve_pairs(Tracks& tracks) {
  std::vector<SolvedPair> pairs = solve(tracks);
  for (int round = 0; round < 2 && !tracks.has_sigma; ++round) {
    double worst = 0;
    for (const SolvedPair& p : pairs)
      worst = std::max(worst, 1.4826 * median_abs(epipolar_residuals(p.pair, p.geometry.fundamental)));
    for (TrackSighting& s : tracks.sightings) s.sigma_px = std::max(0.01, s.sigma_px * worst);
    pairs = solve(tracks);
  }
  return pairs;
}

std::vector<DroppedSighting> drop_pair_outliers(Tracks& tracks, std::vector<SolvedPair>& pairs) {
  std::map<std::pair<int, int>, std::array<double, 3>> votes;  // pairs, pairs that disagree, largest residual
  for (const SolvedPair& p : pairs) {
    const auto r = epipolar_residuals(p.pair, p.geometry.fundamental);
    for (std::size_t i = 0; i < p.pair.size(); ++i)
      for (const int station : {p.pair.a, p.pair.b}) {
        auto& v = votes[{p.pair.points[i], station}];
        v[0] += 1, v[1] += !p.geometry.inlier[i], v[2] = std::max(v[2], std::abs(r[i]));
      }
  }
  std::vector<char> gone;
  for (const TrackSighting& s : tracks.sightings) {
    const auto at = votes.find({s.point, s.station});
    gone.push_back(at != votes.end() && at->second[1] > 0.5 * at->second[0]);
  }
  const std::vector<TrackSighting> before = tracks.sightings;
  auto dropped = drop(tracks, gone, [&](std::size_t i) {
    return votes[{before[i].point, before[i].station}][2];
  });
  for (SolvedPair& p : pairs) {
    p.pair = kept(p.pair, p.geometry.inlier);
    p.geometry.inlier.assign(p.pair.size(), 1);
  }
  return dropped;
}

std::vector<DroppedSighting> drop_misfits(Tracks& tracks, const TrackRig& rig, double variance) {
  const std::vector<double> r = scaled_residuals(tracks, rig);
  std::vector<char> gone(r.size(), 0);
  for (std::size_t begin = 0, end = 0; begin < r.size(); begin = end) {
    double sum = 0;
    std::size_t worst = begin;
    for (end = begin; end < r.size() && tracks.sightings[end].point == tracks.sightings[begin].point; ++end) {
      sum += r[end] * r[end];
      if (r[end] > r[worst]) worst = end;
    }
    const int seen = int(end - begin);
    if (seen >= 2 && sum <= chi2_limit(2 * seen - 3) * variance) continue;
    if (seen > 2 && std::isfinite(sum))
      gone[worst] = 1;
    else
      std::fill(gone.begin() + std::ptrdiff_t(begin), gone.begin() + std::ptrdiff_t(end), char(1));
  }
  return drop(tracks, gone, [&](std::size_t i) { return r[i]; });
}

std::vector<std::string> merge_stations(Tracks& tracks) {
  std::vector<std::string> merged;
  for (bool again = true; again;) {
    again = false;
    Tracks copy = tracks;
    const std::vector<SolvedPair> pairs = solve_pairs(copy);
    for (int y = tracks.station_count() - 1; y > 0 && !again; --y)
      for (int x = 0; x < y && !again; ++x) {
        if (tracks.stations[x].device != tracks.stations[y].device || !same_station(pairs, x, y)) continue;
        merged.push_back(fmt::format("{} stands where {} does, so that only the scene moved",
                                     tracks.station_name(y), tracks.station_name(x)));
        merge(tracks, x, y);
        again = true;
      }
  }
  return merged;
}

}  // namespace laterna
