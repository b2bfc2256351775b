#include "calib/selfcal/track_rig.h"

#include "calib/boards/rig.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// The rows [J_point J_global r]/sigma of one point's sightings [begin, end).
RowMajor point_rows(const Tracks& tracks, const TrackColumns& columns, const TrackRig& rig, std::size_t begin,
                    std::size_t end) {
  RowMajor rows = RowMajor::Zero(2 * Eigen::Index(end - begin), 3 + columns.count + 1);
  RowMajor global(2, columns.count), point(2, 3);
  for (std::size_t i = begin; i < end; ++i) {
    const TrackSighting& s = tracks.sightings[i];
    global.setZero();
    const auto pixel =
        predict(tracks, columns, rig, s.station, rig.points[s.point], global.data(), point.data());
    if (!pixel) continue;
    auto out = rows.middleRows<2>(2 * Eigen::Index(i - begin));
    out.leftCols<3>() = point;
    out.middleCols(3, columns.count) = global;
    out(0, out.cols() - 1) = pixel->x - s.pixel.x;
    out(1, out.cols() - 1) = pixel->y - s.pixel.y;
    out /= s.sigma_px;
  }
  return rows;
}

// First sighting after those of the point that sighting `begin` is of.
std::size_t end_of_point(const Tracks& tracks, std::size_t begin) {
  std::size_t end = begin;
  while (end < tracks.sightings.size() && tracks.sightings[end].point == tracks.sightings[begin].point) ++end;
  return end;
}

// What of a parameter of the device moves the farthest corner of its image by f; 1 where nothing does.
double corner_unit(const LensGradient& lens, const Intrinsics& k, const std::vector<double>& lens_parameters,
                   std::size_t parameter) {
  std::vector<double> all{k.fx, k.fy, k.cx, k.cy}, by_parameter(2 * std::size_t(lens.parameter_count()));
  all.insert(all.end(), lens_parameters.begin(), lens_parameters.end());
  const glm::dvec3 corner(std::max(k.cx, k.size.x - k.cx) / k.fx, std::max(k.cy, k.size.y - k.cy) / k.fy, 1);
  double pixel[2];
  if (!lens.project(all, corner, pixel, nullptr, by_parameter.data())) return 1;
  const double moved = std::hypot(by_parameter[parameter], by_parameter[all.size() + parameter]);
  return moved > 0 && std::isfinite(moved) ? k.fx / moved : 1;
}

}  // namespace

TrackColumns columns_of(const Tracks& tracks) {
  TrackColumns c;
  for (const TrackDevice& d : tracks.devices) {
    std::vector<int> at(4 + d.lens.parameters.size(), -1);
    if (d.focal) at[0] = at[1] = c.count++;
    if (d.aspect) at[1] = c.count++;
    if (d.center) at[2] = c.count++, at[3] = c.count++;
    for (std::size_t i = 0; i < d.lens_free.size(); ++i)
      if (d.lens_free[i]) at[4 + i] = c.count++;
    c.intrinsics.push_back(std::move(at));
    c.lenses.emplace_back(d.lens.model);
  }
  for (int s = 0; s < tracks.station_count(); ++s) {
    c.station.push_back(s == 0 ? -1 : c.count);
    c.count += s == 0 ? 0 : 6;
  }
  return c;
}

std::vector<std::string> column_names(const Tracks& tracks) {
  std::vector<std::string> names;
  for (const TrackDevice& d : tracks.devices) {
    if (d.focal) names.push_back(d.name + (d.aspect ? " fx" : " f"));
    if (d.aspect) names.push_back(d.name + " fy");
    if (d.center) names.push_back(d.name + " cx"), names.push_back(d.name + " cy");
    for (std::size_t i = 0; i < d.lens_free.size(); ++i)
      if (d.lens_free[i]) names.push_back(d.name + " " + lens_parameter_name(d.lens.model, int(i)));
  }
  for (int s = 1; s < tracks.station_count(); ++s)
    for (const char* kind : {"rotation", "translation"})
      for (const char axis : {'x', 'y', 'z'})
        names.push_back(fmt::format("{} {}_{}", tracks.station_name(s), kind, axis));
  return names;
}

TrackRig moved(const Tracks& tracks, const TrackRig& rig, const std::vector<double>& step) {
  const TrackColumns columns = columns_of(tracks);
  TrackRig m = rig;
  for (std::size_t d = 0; d < m.devices.size(); ++d) {
    double* const value[] = {&m.devices[d].fx, &m.devices[d].fy, &m.devices[d].cx, &m.devices[d].cy};
    for (int i = 0; i < 4; ++i)
      if (columns.intrinsics[d][i] >= 0) *value[i] += step[columns.intrinsics[d][i]];
    for (std::size_t i = 0; i < m.lenses[d].size(); ++i)
      if (const int at = columns.intrinsics[d][4 + i]; at >= 0) m.lenses[d][i] += step[at];
  }
  for (std::size_t s = 1; s < m.station_from_first.size(); ++s) {
    const double* by = step.data() + columns.station[s];
    const Rigid turn = rigid_from_rotation_vector({by[0], by[1], by[2]}, glm::dvec3(0.0));
    m.station_from_first[s].rotation = turn.rotation * m.station_from_first[s].rotation;
    m.station_from_first[s].translation += glm::dvec3(by[3], by[4], by[5]);
  }
  return m;
}

ProjectorState state_of(const Tracks& tracks, const TrackRig& rig, int station) {
  const int device = tracks.stations[station].device;
  const Intrinsics& k = rig.devices[device];
  ProjectorState state{{k.fx, k.fy, k.cx, k.cy}, rig.station_from_first[station]};
  state.parameters.insert(state.parameters.end(), rig.lenses[device].begin(), rig.lenses[device].end());
  return state;
}

std::vector<double> natural_units(const Tracks& tracks, const TrackRig& rig) {
  const TrackColumns columns = columns_of(tracks);
  std::vector<double> unit(columns.count, 1.0);
  for (std::size_t d = 0; d < rig.devices.size(); ++d)
    for (std::size_t i = 0; i < columns.intrinsics[d].size(); ++i)
      if (const int at = columns.intrinsics[d][i]; at >= 0)
        unit[at] =
            i < 4 ? rig.devices[d].fx : corner_unit(columns.lenses[d], rig.devices[d], rig.lenses[d], i);
  double length = 0;
  for (const Rigid& place : rig.station_from_first)
    length += glm::length(place.translation) / double(rig.station_from_first.size() - 1);
  for (const int at : columns.station)
    for (int i = 3; i < 6 && at >= 0; ++i) unit[at + i] = length;
  return unit;
}

std::optional<glm::dvec2> predict(const Tracks& tracks, const TrackColumns& columns, const TrackRig& rig,
                                  int station, const glm::dvec3& x_first, double* by_global,
                                  double* by_point) {
  const int device = tracks.stations[station].device;
  const LensGradient& lens = columns.lenses[device];
  const int k = lens.parameter_count(), p = k + 6;
  const ProjectorState state = state_of(tracks, rig, station);
  const bool with_rows = by_global || by_point;
  std::vector<double> rows(with_rows ? 2 * std::size_t(p) : 0);
  double pixel[2];
  if (!project_with_rows(lens, state, x_first, pixel, with_rows ? rows.data() : nullptr)) return std::nullopt;
  for (int r = 0; r < 2 && with_rows; ++r) {
    const double* row = rows.data() + r * p;
    const glm::dvec3 g(row[k + 3], row[k + 4], row[k + 5]);
    const glm::dvec3 along = g * state.device_from_points.rotation;  // a row times a matrix
    for (int i = 0; i < 3 && by_point; ++i) by_point[3 * r + i] = along[i];
    if (!by_global) continue;
    double* out = by_global + r * columns.count;
    for (int i = 0; i < k; ++i)
      if (const int at = columns.intrinsics[device][i]; at >= 0) out[at] += row[i];
    for (int i = 0; i < 6 && columns.station[station] >= 0; ++i)
      out[columns.station[station] + i] += row[k + i];
  }
  return glm::dvec2(pixel[0], pixel[1]);
}

std::vector<double> scaled_residuals(const Tracks& tracks, const TrackRig& rig) {
  const TrackColumns columns = columns_of(tracks);
  std::vector<double> r;
  for (const TrackSighting& s : tracks.sightings) {
    const auto pixel = predict(tracks, columns, rig, s.station, rig.points[s.point]);
    r.push_back(pixel ? glm::length(*pixel - s.pixel) / s.sigma_px : INFINITY);
  }
  return r;
}

std::vector<double> eliminated_factor(const Tracks& tracks, const TrackRig& rig) {
  const TrackColumns columns = columns_of(tracks);
  const int n = columns.count + 1;
  constexpr Eigen::Index batch = 512;
  Eigen::MatrixXd stack = Eigen::MatrixXd::Zero(n + batch, n);
  Eigen::Index used = n;
  const auto fold = [&] {
    const Eigen::MatrixXd r =
        Eigen::HouseholderQR<Eigen::MatrixXd>(stack.topRows(std::max<Eigen::Index>(used, n)))
            .matrixQR()
            .topRows(n)
            .triangularView<Eigen::Upper>();
    stack.setZero();
    stack.topRows(n) = r;
    used = n;
  };
  for (std::size_t begin = 0; begin < tracks.sightings.size();) {
    const std::size_t end = end_of_point(tracks, begin);
    if (rig.has_point(tracks.sightings[begin].point) && end - begin >= 2) {
      const RowMajor rows = point_rows(tracks, columns, rig, begin, end);
      const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows.leftCols<3>());
      const Eigen::MatrixXd rest =
          (qr.householderQ().adjoint() * rows.rightCols(n)).bottomRows(rows.rows() - 3);
      if (used + rest.rows() > stack.rows()) fold();
      if (used + rest.rows() > stack.rows()) stack.conservativeResize(used + rest.rows(), n);
      stack.middleRows(used, rest.rows()) = rest;
      used += rest.rows();
    }
    begin = end;
  }
  fold();
  const RowMajor r = stack.topRows(n);
  return {r.data(), r.data() + r.size()};
}

std::vector<double> baseline_row(const Tracks& tracks, const TrackRig& rig, const UnitBaseline& baseline) {
  const TrackColumns columns = columns_of(tracks);
  const auto& [a, b] = baseline;
  const glm::dvec3 between =
      glm::normalize(center_in_world(rig.station_from_first[b]) - center_in_world(rig.station_from_first[a]));
  std::vector<double> row(columns.count, 0.0);
  for (const auto& [station, sign] : {std::pair(a, -1.0), std::pair(b, 1.0)}) {
    if (columns.station[station] < 0) continue;
    // c = -Rᵀt: dc = -Rᵀ·dt + Rᵀ·(w × t).
    const Rigid& place = rig.station_from_first[station];
    const glm::dvec3 g = sign * (place.rotation * between), turn = glm::cross(place.translation, g);
    for (int i = 0; i < 3; ++i) {
      row[columns.station[station] + i] += turn[i];
      row[columns.station[station] + 3 + i] -= g[i];
    }
  }
  return row;
}

std::optional<PointStep> point_step(const Tracks& tracks, const TrackRig& rig, int point) {
  const TrackColumns columns = columns_of(tracks);
  const auto first = std::lower_bound(tracks.sightings.begin(), tracks.sightings.end(), point,
                                      [](const TrackSighting& s, int p) { return s.point < p; });
  const std::size_t begin = std::size_t(first - tracks.sightings.begin());
  if (begin == tracks.sightings.size() || first->point != point || !rig.has_point(point)) return std::nullopt;
  const RowMajor rows = point_rows(tracks, columns, rig, begin, end_of_point(tracks, begin));
  const Eigen::Matrix3d h = rows.leftCols<3>().transpose() * rows.leftCols<3>();
  const Eigen::LDLT<Eigen::Matrix3d> ldlt(h);
  const Eigen::Matrix3d own = ldlt.solve(Eigen::Matrix3d::Identity());
  if (rows.rows() < 4 || !own.allFinite()) return std::nullopt;
  const RowMajor follow = -own * rows.leftCols<3>().transpose() * rows.middleCols(3, columns.count);
  PointStep step{{follow.data(), follow.data() + follow.size()}, {}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) step.own[j][i] = own(i, j);
  return step;
}

}  // namespace laterna
