// Every way of calibrating a camera and a projector from boards, behind one signature, to compare.
#pragma once

#include "calib/boards/held_out.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace laterna {

/// A complete calibration without a guess: the rig of the capture under the model. Throws Refusal, with the
/// reason, where the method cannot take this capture or this model, or fails.
struct BoardMethod {
  const char* name;
  BoardRig (*solve)(const BoardCapture& capture, const RigModel& model);
};

/// joint: start_rig() and adjust(). stepwise: start_rig() and adjust_stepwise(). opencv-stepwise:
/// cv::calibrateCamera, then cv::stereoCalibrate with its intrinsics held. opencv-joint: cv::stereoCalibrate
/// with everything free. mrcal: mrcal_optimize from start_rig() (no outlier rejection; regularised
/// where the lens is splined).
/// OpenCV's iterate up to 500 times: its 30 by default stop early.
std::span<const BoardMethod> board_methods();

/// What a method makes of a capture.
struct MethodResult {
  std::string name;
  std::optional<BoardRig> rig;
  std::string failure;                 ///< the reason where there is no rig
  std::vector<double> fit_rms_px;      ///< of each device
  HeldOut held_out;                    ///< the method itself solves every fold, from nothing
  double seconds = 0;                  ///< of one solve of the whole capture, wall clock
  std::optional<double> over_bound{};  ///< error over the Cramér-Rao bound; none without a truth
};

/// Runs every method on the same sightings.
std::vector<MethodResult> compare_board_methods(const BoardCapture& capture, const RigModel& model);

/// The OpenCV and mrcal entries of the table.
BoardRig solve_opencv_stepwise(const BoardCapture& capture, const RigModel& model);
BoardRig solve_opencv_joint(const BoardCapture& capture, const RigModel& model);
BoardRig solve_mrcal(const BoardCapture& capture, const RigModel& model);

}  // namespace laterna
