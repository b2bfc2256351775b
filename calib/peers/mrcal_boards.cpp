// mrcal's joint optimisation, as a peer.
#include "calib/boards/rig_start.h"
#include "calib/peers/board_methods.h"
#include "sim/error.h"
#include "sim/spline_knots.h"

#include <algorithm>
#include <cmath>
#include <set>

extern "C" {
#include <mrcal/mrcal.h>
}

namespace laterna {

namespace {

// The regular grid that mrcal's boards are.
struct Grid {
  double spacing = 0;
  int width = 0, height = 0;
};

int steps(double value, double spacing) { return int(std::lround(value / spacing)); }

Grid grid_of(const BoardCapture& capture) {
  Grid grid;
  double most_x = 0, most_y = 0, least = INFINITY;
  for (const Sighting& s : capture.sightings) {
    for (const double v : {s.x_board.x, s.x_board.y})
      if (v > 0) least = std::min(least, v);
    most_x = std::max(most_x, s.x_board.x), most_y = std::max(most_y, s.x_board.y);
  }
  grid.spacing = least;
  grid.width = steps(most_x, least) + 1, grid.height = steps(most_y, least) + 1;
  const bool sized = std::isfinite(least) && grid.width <= 1000 && grid.height <= 1000;
  const bool regular =
      sized && std::all_of(capture.sightings.begin(), capture.sightings.end(), [&](const Sighting& s) {
        const glm::dvec3 node(grid.spacing * steps(s.x_board.x, least),
                              grid.spacing * steps(s.x_board.y, least), 0);
        return s.x_board.x >= 0 && s.x_board.y >= 0 && glm::length(s.x_board - node) < 1e-6 * grid.spacing;
      });
  if (!regular) throw Refusal("mrcal takes boards whose corners are a regular grid from (0, 0)");
  return grid;
}

mrcal_lensmodel_t model_of(const RigModel& model) {
  const DeviceModel& first = model.devices[0];
  for (const DeviceModel& m : model.devices) {
    const bool whole = std::all_of(m.lens_free.begin(), m.lens_free.end(), [](bool f) { return f; });
    if (m.lens_model != first.lens_model || !whole || m.one_focal_length || m.fixed_center)
      throw Refusal("mrcal takes one whole lens model for all devices");
  }
  mrcal_lensmodel_t lensmodel{};
  if (!mrcal_lensmodel_from_name(&lensmodel, first.lens_model.c_str()))
    throw Refusal("mrcal does not know this lens model");
  return lensmodel;
}

mrcal_pose_t pose_of(const Rigid& rigid) {
  const glm::dvec3 w = rotation_vector_rad(rigid.rotation), t = rigid.translation;
  mrcal_pose_t pose{};
  for (int i = 0; i < 3; ++i) pose.r.xyz[i] = w[i], pose.t.xyz[i] = t[i];
  return pose;
}

Rigid rigid_of(const mrcal_pose_t& pose) {
  return rigid_from_rotation_vector({pose.r.x, pose.r.y, pose.r.z}, {pose.t.x, pose.t.y, pose.t.z});
}

// Every device's view of every pose, in mrcal's order; absent corners have a negative weight.
struct Observations {
  std::vector<mrcal_observation_board_t> boards;
  std::vector<mrcal_point3_t> pool;
};

Observations observations_of(const BoardCapture& capture, const Grid& grid) {
  Observations o;
  const int corners = grid.width * grid.height, devices = int(capture.devices.size());
  for (int pose = 0; pose < capture.pose_count(); ++pose)
    for (int d = 0; d < devices; ++d) o.boards.push_back({{d, d - 1}, pose});
  mrcal_point3_t absent{};
  absent.z = -1;
  o.pool.assign(o.boards.size() * std::size_t(corners), absent);
  for (const Sighting& s : capture.sightings) {
    const int at = steps(s.x_board.y, grid.spacing) * grid.width + steps(s.x_board.x, grid.spacing);
    mrcal_point3_t& point = o.pool[std::size_t(s.pose * devices + s.device) * corners + at];
    point.x = s.pixel.x, point.y = s.pixel.y, point.z = 1 / s.sigma_px;
  }
  return o;
}

}  // namespace

BoardRig solve_mrcal(const BoardCapture& capture, const RigModel& model) {
  const mrcal_lensmodel_t lensmodel = model_of(model);
  const Grid grid = grid_of(capture);
  const RigStart start = start_rig(capture);
  if (!start.rig) throw Refusal(start.refusal);
  BoardRig rig = fitted_to(*start.rig, model, capture);

  const int devices = int(rig.devices.size()), poses = capture.pose_count();
  std::vector<double> intrinsics;
  std::vector<int> sizes;
  std::vector<mrcal_pose_t> extrinsics, frames;
  for (int d = 0; d < devices; ++d) {
    intrinsics.insert(intrinsics.end(), rig.devices[d].parameters.begin(), rig.devices[d].parameters.end());
    sizes.insert(sizes.end(), {capture.devices[d].size.x, capture.devices[d].size.y});
    if (d > 0) extrinsics.push_back(pose_of(rig.devices[d].device_from_camera));
  }
  for (const Rigid& pose : rig.camera_from_board) frames.push_back(pose_of(pose));
  Observations o = observations_of(capture, grid);
  mrcal_problem_selections_t free{};
  free.do_optimize_extrinsics = free.do_optimize_frames = true;
  const bool splined = is_splined(model.devices[0].lens_model);
  free.do_optimize_intrinsics_core = !splined;
  free.do_apply_regularization = splined;  // or knots that no point reaches have no value
  free.do_optimize_intrinsics_distortions = !model.devices[0].lens_free.empty();
  free.do_optimize_calobject_warp = model.bend;
  mrcal_calobject_warp_t warp{};
  const mrcal_problem_constants_t constants{};
  const mrcal_stats_t stats = mrcal_optimize(
      nullptr, 0, nullptr, 0, intrinsics.data(), extrinsics.data(), frames.data(), nullptr, &warp, devices,
      devices - 1, poses, 0, 0, o.boards.data(), nullptr, int(o.boards.size()), 0, o.pool.data(), &lensmodel,
      sizes.data(), free, &constants, grid.spacing, grid.width, grid.height, false, false);
  if (!(stats.rms_reproj_error__pixels >= 0)) throw Refusal("mrcal's optimisation fails");

  const std::size_t count = rig.devices[0].parameters.size();
  for (int d = 0; d < devices; ++d) {
    std::copy_n(intrinsics.begin() + std::ptrdiff_t(d * count), count, rig.devices[d].parameters.begin());
    if (d > 0) rig.devices[d].device_from_camera = rigid_of(extrinsics[d - 1]);
  }
  for (int k = 0; k < poses; ++k) rig.camera_from_board[k] = rigid_of(frames[k]);
  rig.bend = {warp.x2, warp.y2};
  return rig;
}

}  // namespace laterna
