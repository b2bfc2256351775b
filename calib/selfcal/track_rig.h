// Devices, their placements and the points while they are solved for, and what the pixels say about them.
//
// Frames: *first* is the device frame of station 0. x_station = station_from_first·x_first, pixel =
// lens(device, x_station).
#pragma once

#include "calib/projection_rows.h"
#include "calib/selfcal/tracks.h"
#include "sim/rigid.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace laterna {

struct TrackRig {
  std::vector<Intrinsics> devices;
  std::vector<Rigid> station_from_first;    ///< the first is the identity
  std::vector<glm::dvec3> points;           ///< in the first station's frame; NaN where not placed
  std::vector<std::vector<double>> lenses;  ///< of each device: the parameters of its lens model

  bool has_point(int p) const { return points[p].x == points[p].x; }
};

/// Two stations whose centres are 1 apart, because no pixel tells how far.
using UnitBaseline = std::pair<int, int>;

/// Where the free parameters stand among the global columns: intrinsics and lens of each device, then
/// rotation and translation of each station but the first.
struct TrackColumns {
  std::vector<std::vector<int>> intrinsics;  ///< of fx, fy, cx, cy, lens; -1 where held; fx and fy may share
  std::vector<int> station;                  ///< rotation (3), translation (3); -1 for the first
  int count = 0;
  std::vector<LensGradient> lenses;  ///< of each device: what turns columns into pixels
};
TrackColumns columns_of(const Tracks& tracks);

/// "projector f", "projector k1", "projector at 2 rotation_x": one per global column.
std::vector<std::string> column_names(const Tracks& tracks);

/// Moves devices and stations by a step: intrinsics by addition, rotations R = exp([w]×)·R̂ in the station's
/// frame, translations by addition; the points stay.
TrackRig moved(const Tracks& tracks, const TrackRig& rig, const std::vector<double>& step);

/// A station as projection_rows.h knows it: fx, fy, cx, cy, lens parameters, and its place.
ProjectorState state_of(const Tracks& tracks, const TrackRig& rig, int station);

/// The size of a natural step of each global column: a share of f for focal lengths and centres, what moves
/// the image's farthest corner by f for a lens parameter, a radian, a share of the mean baseline.
std::vector<double> natural_units(const Tracks& tracks, const TrackRig& rig);

/// The pixel of a point in a station; none where it lies behind, or is not placed. Unless null, `by_global`
/// is increased by its two rows of derivatives (row-major 2×columns.count), and `by_point` (2×3) set.
std::optional<glm::dvec2> predict(const Tracks& tracks, const TrackColumns& columns, const TrackRig& rig,
                                  int station, const glm::dvec3& x_first, double* by_global = nullptr,
                                  double* by_point = nullptr);

/// |x_station's predicted pixel - measured| / sigma of each sighting; infinite where there is none.
std::vector<double> scaled_residuals(const Tracks& tracks, const TrackRig& rig);

/// R with RᵀR = AᵀA for all rows A = [J_global r]/sigma with the points eliminated, row-major (count + 1)²:
/// its last column holds the residual. Needs a rig under which no sighting of a placed point lies behind.
std::vector<double> eliminated_factor(const Tracks& tracks, const TrackRig& rig);

/// The derivative of the distance between the centres of two stations by the global columns.
std::vector<double> baseline_row(const Tracks& tracks, const TrackRig& rig, const UnitBaseline& baseline);

/// What the pixels say about a point, given the rest: a step of the point is follow·(global step) + ε.
struct PointStep {
  std::vector<double> follow;  ///< row-major 3×count
  glm::dmat3 own{0.0};         ///< covariance of ε
};
std::optional<PointStep> point_step(const Tracks& tracks, const TrackRig& rig, int point);

}  // namespace laterna
