// Where a joint adjustment starts: a rig without a guess.
#pragma once

#include "calib/boards/rig.h"

#include <optional>
#include <string>

namespace laterna {

struct RigStart {
  std::optional<BoardRig> rig;  ///< pinhole devices, but for known ones
  std::string refusal;          ///< one sentence; empty where there is a rig
};

/// Device 0: one focal length and a centred principal point, from the boards' homographies (Zhang 2000, as
/// cv::initCameraMatrix2D has it) and, where that fits badly, from nominal focal lengths; each board pose by
/// IPPE (Collins and Bartoli 2014), or SQPNP for a board with relief; then an adjustment of the camera alone.
/// Every other device: the board points, now in the camera's frame, give it by the known-geometry starts
/// (candidates.h): DLT, RANSAC, nominal focal lengths. A principal point outside the image is fine.
///
/// A device whose intrinsics are known keeps them and its lens, and starts from its placement (solve.h).
///
/// Refused: no pose, a pose that the camera sees fewer than 4 corners of, another device with too few points
/// or with all its points in one plane.
RigStart start_rig(const BoardCapture& capture);

/// The pose of the board from the sightings of device 0 in one pose; none where there are fewer than 4, or no
/// pose has all of them in front.
std::optional<Rigid> board_pose(const BoardCapture& capture, int pose, const std::vector<double>& pinhole);

}  // namespace laterna
