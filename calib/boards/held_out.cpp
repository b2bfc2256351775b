#include "calib/boards/held_out.h"

#include "sim/parallel.h"

#include <cmath>

namespace laterna {

namespace {

BoardRig without_pose(BoardRig rig, int pose) {
  rig.camera_from_board.erase(rig.camera_from_board.begin() + pose);
  return rig;
}

// The board's pose in a capture of one pose, from the cameras alone; everything else of the rig stays.
std::optional<BoardRig> with_pose_from_cameras(const BoardCapture& one, RigModel model, const BoardRig& rig) {
  for (DeviceModel& device : model.devices) device.held = true;
  model.bend = model.hold_poses = false;
  const auto adjusted = adjust({seen_by_cameras(one), model}, rig);
  if (!adjusted || !adjusted->converged) return std::nullopt;
  return adjusted->rig;
}

// False where a point lies behind a device.
bool add_errors(const BoardCapture& one, const RigModel& model, const BoardRig& rig, HeldOutPose& fold) {
  const RigProblem problem(one, model);
  double sum = 0;
  for (const Sighting& s : one.sightings) {
    if (is_camera(one, s.device)) continue;
    double pixel[2];
    if (!predict(problem, rig, s, pixel, nullptr)) return false;
    sum += std::pow(pixel[0] - s.pixel.x, 2) + std::pow(pixel[1] - s.pixel.y, 2);
    ++fold.sightings;
  }
  fold.rms_px = fold.sightings > 0 ? std::sqrt(sum / double(fold.sightings)) : 0;
  return true;
}

std::optional<HeldOutPose> hold_out(const BoardCapture& capture, const RigModel& model, const BoardRig& rig,
                                    int pose, const Calibrator& calibrate) {
  const auto trained = calibrate(without_pose(capture, pose), without_pose(rig, pose));
  if (!trained) return std::nullopt;
  const BoardCapture one = with_poses(capture, {pose});
  BoardRig start = *trained;
  start.camera_from_board = {rig.camera_from_board[pose]};
  const auto placed = with_pose_from_cameras(one, model, start);
  HeldOutPose fold{pose, 0, 0, *trained};
  if (!placed || !add_errors(one, model, *placed, fold)) return std::nullopt;
  return fold;
}

}  // namespace

HeldOut hold_out_poses(const BoardCapture& capture, const RigModel& model, const BoardRig& rig,
                       const Calibrator& calibrate) {
  std::vector<std::optional<HeldOutPose>> folds(capture.pose_labels.size());
  if (folds.size() >= 2)
    parallel_for(folds.size(),
                 [&](std::size_t k) { folds[k] = hold_out(capture, model, rig, int(k), calibrate); });
  HeldOut result;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < folds.size(); ++k) {
    if (!folds[k]) {
      result.failed.push_back(int(k));
      continue;
    }
    sum += folds[k]->rms_px * folds[k]->rms_px * double(folds[k]->sightings);
    count += folds[k]->sightings;
    result.folds.push_back(std::move(*folds[k]));
  }
  result.rms_px = count > 0 ? std::sqrt(sum / double(count)) : 0;
  return result;
}

HeldOut hold_out_poses(const BoardCapture& capture, const RigModel& model, const BoardRig& rig) {
  return hold_out_poses(capture, model, rig,
                        [&](const BoardCapture& others, const BoardRig& start) -> std::optional<BoardRig> {
                          const auto adjusted = adjust({others, model}, start);
                          if (!adjusted || !adjusted->converged) return std::nullopt;
                          return adjusted->rig;
                        });
}

}  // namespace laterna
