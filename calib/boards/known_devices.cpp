#include "calib/boards/known_devices.h"

#include "calib/placement.h"

#include <fmt/format.h>

#include <algorithm>

namespace laterna {

namespace {

// The points that device d sees in the frame that `target_from_board` puts each pose's board into.
Correspondences points_of(const RigFit& fit, int d, const std::vector<Rigid>& target_from_board,
                          int only_pose) {
  Correspondences c;
  for (const Sighting& s : fit.capture.sightings) {
    if (s.device != d || (only_pose >= 0 && s.pose != only_pose)) continue;
    c.world_points.push_back(
        apply(target_from_board[s.pose], bent(s.x_board, fit.capture.extent, fit.adjustment.rig.bend)));
    c.projector_pixels.push_back(s.pixel);
    c.sigma_px.push_back(std::max(fit.sigma_px[d], 1e-6));
  }
  return c;
}

std::string twin_of(const RigFit& fit, int d, const Correspondences& points, const std::string& what) {
  const BoardDevice& device = fit.capture.devices[d];
  const std::string twin =
      place(points, {device.known->intrinsics, device.known->lens, device.known_sigma}).ambiguity;
  return twin.empty() ? "" : fmt::format("{}{}: {}", fit.capture.devices[d].name, what, twin);
}

}  // namespace

DeviceModel device_model(const BoardDevice& device, const std::vector<std::string>& terms) {
  if (!device.known) return model_of_terms(terms);
  DeviceModel model;
  model.lens_model = device.known->lens.model;
  model.known =
      std::all_of(device.known_sigma.begin(), device.known_sigma.end(), [](double s) { return s == 0; });
  model.lens_free.assign(device.known->lens.parameters.size(), !model.known);
  if (!model.known)
    model.prior = prior_of({device.known->intrinsics, device.known->lens, device.known_sigma});
  return model;
}

bool all_known(const BoardCapture& capture) {
  return std::all_of(capture.devices.begin(), capture.devices.end(),
                     [](const BoardDevice& device) { return device.known.has_value(); });
}

BoardCapture straightened(const BoardCapture& capture) {
  BoardCapture straight = capture;
  for (std::size_t d = 0; d < capture.devices.size(); ++d) {
    if (!capture.devices[d].known || is_pinhole(capture.devices[d].known->lens)) continue;
    const Intrinsics& k = capture.devices[d].known->intrinsics;
    const LensProjection lens(k, capture.devices[d].known->lens), pinhole(k, Lens{});
    std::erase_if(straight.sightings, [&](Sighting& s) {
      if (s.device != int(d)) return false;
      const auto ray = lens.unproject(s.pixel);
      if (ray) s.pixel = *pinhole.project(*ray);
      return !ray;
    });
  }
  return straight;
}

std::string second_placement(const RigFit& fit) {
  const std::vector<Rigid>& boards = fit.adjustment.rig.camera_from_board;
  const std::vector<Rigid> itself(boards.size());
  if (fit.capture.devices[0].known) {
    for (int k = 0; k < fit.capture.pose_count(); ++k) {
      const std::string what = fmt::format(", pose {}", fit.capture.pose_labels[k]);
      std::string twin = twin_of(fit, 0, points_of(fit, 0, itself, k), what);
      if (!twin.empty()) return twin;
    }
  }
  for (int d = 1; d < int(fit.capture.devices.size()); ++d) {
    if (!fit.capture.devices[d].known) continue;
    std::string twin = twin_of(fit, d, points_of(fit, d, boards, -1), "");
    if (!twin.empty()) return twin;
  }
  return "";
}

}  // namespace laterna
