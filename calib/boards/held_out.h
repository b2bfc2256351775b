// What a calibration is worth on a pose that it never saw.
#pragma once

#include "calib/boards/rig_fit.h"

#include <functional>
#include <optional>
#include <vector>

namespace laterna {

struct HeldOutPose {
  int pose = 0;       ///< index into the whole capture
  double rms_px = 0;  ///< sqrt(mean(du² + dv²)) over its sightings by projectors
  std::size_t sightings = 0;
  BoardRig rig;  ///< solved for without it
};

struct HeldOut {
  double rms_px = 0;  ///< over all sightings of all folds
  std::vector<HeldOutPose> folds;
  std::vector<int> failed;  ///< poses without which there was no solution, or that got no pose themselves
};

/// A calibration of a capture from a start; none where it fails.
using Calibrator = std::function<std::optional<BoardRig>(const BoardCapture&, const BoardRig& start)>;

/// Leaves each pose out in turn: `calibrate` solves for the rig from the others (starting at `rig`); the
/// board's pose comes from the cameras' pixels alone with that rig's cameras and bend; then the projectors'
/// pixels are predicted. `model` names the lenses of the rigs. Folds run in parallel. A fold without
/// sightings by projectors has rms 0.
HeldOut hold_out_poses(const BoardCapture& capture, const RigModel& model, const BoardRig& rig,
                       const Calibrator& calibrate);

/// The same with adjust() under `model` and the capture's sigmas.
HeldOut hold_out_poses(const BoardCapture& capture, const RigModel& model, const BoardRig& rig);

}  // namespace laterna
