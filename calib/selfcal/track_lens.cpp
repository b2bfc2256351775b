#include "calib/selfcal/track_lens.h"

#include "calib/boards/rig.h"
#include "calib/selfcal/track_covariance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

const char* const tested_lens = "opencv4";

bool undone(const TrackDevice& device) { return device.lens_known() && !device.focal && !device.center; }

// The pixel that K alone would give.
std::optional<glm::dvec2> without_lens(const LensProjection& lens, const glm::dvec2& pixel) {
  const auto ray = lens.unproject(pixel);
  const Intrinsics& k = lens.intrinsics();
  if (!ray) return std::nullopt;
  return glm::dvec2(k.fx * ray->x / ray->z + k.cx, k.fy * ray->y / ray->z + k.cy);
}

// rms over the points that a device's stations see of what a step of the global columns moves there.
double moved_px(const Tracks& tracks, const TrackColumns& columns, const TrackRig& rig,
                const std::vector<double>& step, int device) {
  double sum = 0, count = 0;
  std::vector<double> rows(2 * std::size_t(columns.count));
  for (const TrackSighting& s : tracks.sightings) {
    std::fill(rows.begin(), rows.end(), 0.0);
    if (tracks.stations[s.station].device != device || !rig.has_point(s.point) ||
        !predict(tracks, columns, rig, s.station, rig.points[s.point], rows.data()))
      continue;
    for (int r = 0; r < 2; ++r) {
      double by = 0;
      for (int i = 0; i < columns.count; ++i)
        by += rows[std::size_t(r) * std::size_t(columns.count) + std::size_t(i)] * step[i];
      sum += by * by;
    }
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

// Wald's test of the parameters `tested` among the global columns.
double wald(const TrackCovariance& c, const std::vector<int>& tested, int count) {
  const Eigen::Index n = Eigen::Index(tested.size());
  Eigen::VectorXd k(n);
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    k[i] = c.step[tested[i]];
    for (Eigen::Index j = 0; j < n; ++j) covariance(i, j) = c.global[tested[i] * count + tested[j]];
  }
  return k.dot(covariance.ldlt().solve(k));
}

// What freeing the rest of k1, k2, p1, p2 of one device would change.
TrackLensLeftOut left_out_of(Tracks tracks, TrackRig rig, const std::vector<UnitBaseline>& units,
                             double variance, std::size_t device) {
  std::vector<bool> had = tracks.devices[device].lens_free;
  set_lens_terms(tracks, rig, device, lens_terms(tested_lens));
  had.resize(tracks.devices[device].lens_free.size(), false);
  const TrackColumns columns = columns_of(tracks);
  std::vector<int> tested;
  for (std::size_t i = 0; i < had.size(); ++i)
    if (!had[i]) tested.push_back(columns.intrinsics[device][4 + i]);
  const TrackCovariance c = track_covariance(tracks, rig, units, variance);
  if (c.step.empty() || tested.empty()) return {};
  TrackLensLeftOut left{tracks.devices[device].name, 0, wald(c, tested, columns.count), 0,
                        int(tested.size())};
  left.k1 = rig.lenses[device][0] + c.step[columns.intrinsics[device][4]];
  std::vector<double> lens_step(c.step.size(), 0.0);
  for (const int at : tested) lens_step[at] = c.step[at];
  left.moved_px = moved_px(tracks, columns, rig, lens_step, int(device));
  return std::isfinite(left.chi2) ? left : TrackLensLeftOut{};
}

}  // namespace

Tracks pinhole_view(const Tracks& tracks, std::vector<DroppedSighting>& left_out) {
  Tracks view = tracks;
  for (std::size_t d = 0; d < view.devices.size(); ++d) {
    TrackDevice& device = view.devices[d];
    if (undone(device)) {
      const LensProjection lens(device.intrinsics, device.lens);
      std::erase_if(view.sightings, [&](TrackSighting& s) {
        if (view.stations[s.station].device != int(d)) return false;
        const auto pixel = without_lens(lens, s.pixel);
        if (!pixel) left_out.push_back({s, INFINITY});
        if (pixel) s.pixel = *pixel;
        return !pixel;
      });
    }
    device.lens = {}, device.lens_free.clear(), device.lens_climbs = false;
  }
  return view;
}

void put_lens_back(const TrackDevice& device, glm::dvec2& pixel) {
  if (!undone(device)) return;
  if (const auto warped = LensProjection(device.intrinsics, device.lens).warp(pixel)) pixel = *warped;
}

void put_lenses_back(const std::vector<TrackDevice>& devices, Tracks& tracks) {
  tracks.devices = devices;
  for (std::size_t d = 0; d < devices.size(); ++d) {
    if (!undone(devices[d])) continue;
    const LensProjection lens(devices[d].intrinsics, devices[d].lens);
    for (TrackSighting& s : tracks.sightings) {
      if (tracks.stations[s.station].device != int(d)) continue;
      if (const auto warped = lens.warp(s.pixel)) s.pixel = *warped;
    }
  }
}

void set_lens_terms(Tracks& tracks, TrackRig& rig, std::size_t device,
                    const std::vector<std::string>& terms) {
  const DeviceModel model = model_of_terms(terms);
  TrackDevice& d = tracks.devices[device];
  d.lens.model = model.lens_model;
  d.lens.parameters.resize(model.lens_free.size(), 0.0);
  d.lens_free = model.lens_free;
  rig.lenses[device].resize(model.lens_free.size(), 0.0);
}

std::vector<std::string> folded_lenses(const Tracks& tracks, const TrackRig& rig) {
  std::vector<std::string> names;
  for (std::size_t d = 0; d < tracks.devices.size(); ++d) {
    if (tracks.devices[d].lens_free_count() == 0) continue;
    const LensProjection lens(rig.devices[d], {tracks.devices[d].lens.model, rig.lenses[d]});
    const double w = rig.devices[d].size.x - 1, h = rig.devices[d].size.y - 1;
    for (const glm::dvec2& corner : {glm::dvec2(0, 0), glm::dvec2(w, 0), glm::dvec2(0, h), glm::dvec2(w, h)})
      if (!lens.unproject(corner)) {
        names.push_back(tracks.devices[d].name);
        break;
      }
  }
  return names;
}

double largest_lens_sigma(const Tracks& tracks, const TrackRig& rig, const std::vector<double>& sigma) {
  const TrackColumns columns = columns_of(tracks);
  const std::vector<double> unit = natural_units(tracks, rig);
  double largest = 0;
  for (const auto& of_device : columns.intrinsics)
    for (std::size_t i = 4; i < of_device.size(); ++i)
      if (const int at = of_device[i]; at >= 0) largest = std::max(largest, sigma[at] / unit[at]);
  return largest;
}

TrackLensLeftOut track_lens_left_out(const Tracks& tracks, const TrackRig& rig,
                                     const std::vector<UnitBaseline>& units, double variance) {
  TrackLensLeftOut worst;
  for (std::size_t d = 0; d < tracks.devices.size(); ++d) {
    const TrackDevice& device = tracks.devices[d];
    if (device.lens_known() || device.lens.parameters.size() > 4) continue;
    const TrackLensLeftOut left = left_out_of(tracks, rig, units, variance, d);
    if (left.terms > 0 && (worst.terms == 0 || left.chi2 / left.terms > worst.chi2 / worst.terms))
      worst = left;
  }
  return worst;
}

}  // namespace laterna
