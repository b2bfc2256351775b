#include "calib/selfcal/adjust_tracks.h"

#include "calib/selfcal/sighting_cost.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

// All parameters in one piece: Ceres orders blocks by address, and the order must not change.
struct Blocks {
  std::vector<double> values;
  std::vector<std::size_t> device_begin;
  std::size_t station_begin = 0, point_begin = 0;
  double* device(int d) { return values.data() + device_begin[std::size_t(d)]; }
  double* station(int s) { return values.data() + station_begin + 6 * std::size_t(s); }
  double* point(int p) { return values.data() + point_begin + 3 * std::size_t(p); }
};

Blocks blocks_of(const TrackRig& rig) {
  Blocks b;
  auto& values = b.values;
  for (std::size_t d = 0; d < rig.devices.size(); ++d) {
    const Intrinsics& k = rig.devices[d];
    b.device_begin.push_back(values.size());
    for (const double v : {k.fx, k.fy, k.cx, k.cy}) values.push_back(v / track_pixel_scale);
    values.insert(values.end(), rig.lenses[d].begin(), rig.lenses[d].end());
  }
  b.station_begin = values.size();
  for (const Rigid& place : rig.station_from_first) {
    const glm::dvec3 w = rotation_vector_rad(place.rotation);
    const glm::dvec3& t = place.translation;
    values.insert(values.end(), {w.x, w.y, w.z, t.x, t.y, t.z});
  }
  b.point_begin = values.size();
  for (const glm::dvec3& x : rig.points) values.insert(values.end(), {x.x, x.y, x.z});
  return b;
}

bool one_focal(const TrackDevice& d) { return d.focal && !d.aspect; }

TrackRig rig_of(Blocks& b, TrackRig rig, const Tracks& tracks) {
  for (std::size_t d = 0; d < rig.devices.size(); ++d) {
    const double* k = b.device(int(d));
    const int fy = one_focal(tracks.devices[d]) ? 0 : 1;
    rig.devices[d] = {rig.devices[d].size, k[0] * track_pixel_scale, k[fy] * track_pixel_scale,
                      k[2] * track_pixel_scale, k[3] * track_pixel_scale};
    std::copy_n(k + 4, rig.lenses[d].size(), rig.lenses[d].begin());
  }
  for (std::size_t s = 1; s < rig.station_from_first.size(); ++s) {
    const double* p = b.station(int(s));
    rig.station_from_first[s] = rigid_from_rotation_vector({p[0], p[1], p[2]}, {p[3], p[4], p[5]});
  }
  for (std::size_t i = 0; i < rig.points.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) rig.points[i][axis] = b.point(int(i))[axis];
  return rig;
}

// Keeps two stations' centres 1 apart. Any weight does; this one makes 1e-3 of it as dear as a sigma.
struct BaselineResidual {
  template <class T>
  bool operator()(const T* a, const T* b, T* residual) const {
    T between[3] = {T(0), T(0), T(0)};
    for (const auto& [place, sign] : {std::pair(a, -1.0), std::pair(b, 1.0)}) {
      const T back[3] = {-place[0], -place[1], -place[2]};
      T center[3];
      ceres::AngleAxisRotatePoint(back, place + 3, center);
      for (int i = 0; i < 3; ++i) between[i] -= sign * center[i];
    }
    const T squared = between[0] * between[0] + between[1] * between[1] + between[2] * between[2];
    if (!(squared > T(0))) return false;
    residual[0] = 1e3 * (sqrt(squared) - 1.0);
    return true;
  }
};

void hold(ceres::Problem& problem, const TrackDevice& device, double* k) {
  if (!problem.HasParameterBlock(k)) return;
  if (device.free_count() == 0) return problem.SetParameterBlockConstant(k);
  std::vector<int> held;
  if (!device.focal) held.push_back(0);
  if (!device.aspect) held.push_back(1);
  if (!device.center) held.insert(held.end(), {2, 3});
  const int lens = int(device.lens.parameters.size());
  for (int i = 0; i < lens; ++i)
    if (device.lens_free.empty() || !device.lens_free[i]) held.push_back(4 + i);
  if (!held.empty()) problem.SetManifold(k, new ceres::SubsetManifold(4 + lens, held));
}

bool takes_part(const Tracks& tracks, const TrackRig& rig, std::size_t i) {
  const int p = tracks.sightings[i].point;
  const auto same = [&](std::size_t j) {
    return j < tracks.sightings.size() && tracks.sightings[j].point == p;
  };
  return rig.has_point(p) && (same(i + 1) || (i > 0 && same(i - 1)));
}

void build(ceres::Problem& problem, ceres::ParameterBlockOrdering& ordering, const Tracks& tracks,
           const TrackRig& rig, const std::vector<UnitBaseline>& units, const RobustLoss& loss,
           Blocks& blocks) {
  const TrackColumns columns = columns_of(tracks);
  for (std::size_t i = 0; i < tracks.sightings.size(); ++i) {
    if (!takes_part(tracks, rig, i)) continue;
    const TrackSighting& s = tracks.sightings[i];
    const int d = tracks.stations[s.station].device;
    ceres::LossFunction* robust = nullptr;
    if (loss.kind == RobustLoss::Kind::cauchy) robust = new ceres::CauchyLoss(loss.scale_sigmas);
    if (loss.kind == RobustLoss::Kind::huber) robust = new ceres::HuberLoss(loss.scale_sigmas);
    problem.AddResidualBlock(sighting_cost(columns.lenses[d], s, one_focal(tracks.devices[d])).release(),
                             robust, blocks.device(d), blocks.station(s.station), blocks.point(s.point));
    ordering.AddElementToGroup(blocks.point(s.point), 0);
    ordering.AddElementToGroup(blocks.device(d), 1);
    ordering.AddElementToGroup(blocks.station(s.station), 1);
  }
  for (const auto& [a, b] : units) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<BaselineResidual, 1, 6, 6>(new BaselineResidual),
                             nullptr, blocks.station(a), blocks.station(b));
    ordering.AddElementToGroup(blocks.station(a), 1);
    ordering.AddElementToGroup(blocks.station(b), 1);
  }
  for (std::size_t d = 0; d < tracks.devices.size(); ++d)
    hold(problem, tracks.devices[d], blocks.device(int(d)));
  if (problem.HasParameterBlock(blocks.station(0))) problem.SetParameterBlockConstant(blocks.station(0));
}

ceres::Solver::Options solver_options(int max_iterations, double function_tolerance) {
  ceres::Solver::Options o;
  o.max_num_iterations = max_iterations;
  o.function_tolerance = function_tolerance;
  o.gradient_tolerance = 1e-14;
  o.parameter_tolerance = 1e-13;
  o.max_num_consecutive_invalid_steps = 50;
  o.max_trust_region_radius = 1e12;  // some damping always, or Cholesky of a weak problem fails
  o.num_threads = 1;
  o.logging_type = ceres::SILENT;
  o.linear_solver_type = ceres::DENSE_SCHUR;
  return o;
}

}  // namespace

std::optional<TrackAdjustment> adjust_tracks(const Tracks& tracks, const TrackRig& start,
                                             const std::vector<UnitBaseline>& units, const RobustLoss& loss,
                                             int max_iterations, double function_tolerance) {
  for (std::size_t i = 0; i < tracks.sightings.size(); ++i) {
    const TrackSighting& s = tracks.sightings[i];
    if (takes_part(tracks, start, i) &&
        !(apply(start.station_from_first[s.station], start.points[s.point]).z > 0))
      return std::nullopt;
  }
  Blocks blocks = blocks_of(start);
  ceres::Problem problem;
  ceres::Solver::Options options = solver_options(max_iterations, function_tolerance);
  options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  build(problem, *options.linear_solver_ordering, tracks, start, units, loss, blocks);
  if (problem.NumResidualBlocks() == 0) return std::nullopt;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable() || !std::isfinite(summary.final_cost)) return std::nullopt;

  TrackAdjustment result;
  result.rig = rig_of(blocks, start, tracks);
  const std::vector<double> r = scaled_residuals(tracks, result.rig);
  for (std::size_t i = 0; i < r.size(); ++i)
    if (takes_part(tracks, start, i)) result.loss += loss.rho(r[i] * r[i]);
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.iterations = int(summary.iterations.size()) - 1;
  result.termination = summary.message;
  if (!std::isfinite(result.loss)) return std::nullopt;
  return result;
}

}  // namespace laterna
