// Where a joint adjustment starts: a rig without a guess.
#pragma once

#include "calib/boards/rig.h"

#include <optional>
#include <string>
#include <vector>

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
/// A pose that device 0 does not see comes from another camera that stands already, and may in turn place
/// devices.
///
/// Refused: no pose that device 0 sees, a pose that every camera sees fewer than 4 corners of, another device
/// with too few points or with all its points in one plane.
RigStart start_rig(const BoardCapture& capture);

/// The indices of the poses of which a device sees 4 corners or more.
std::vector<int> poses_seen_by(const BoardCapture& capture, int device);

/// device_from_board from the sightings of a device in one pose, `pinhole` being its fx, fy, cx, cy; none
/// where there are fewer than 4, or no pose has all of them in front.
std::optional<Rigid> board_pose(const BoardCapture& capture, int device, int pose,
                                const std::vector<double>& pinhole);

}  // namespace laterna
