// A rig as calibration files know it: cameras and projectors, each with intrinsics, lens and placement.
#pragma once

#include "sim/device.h"

#include <string>
#include <vector>

namespace laterna {

/// Sentences about what a format could not hold, or what a reader could not take as it stands.
using Notes = std::vector<std::string>;

/// What one calibration file, in whatever format, says after reading: pixel centres at whole numbers, devices
/// x right, y down, z forward, lengths in metres, device_from_world of the file's own world (which need not
/// be the scene's). Light planes are not part of any such file and stand at their defaults.
struct Rig {
  std::vector<Device> cameras, projectors;
  /// Cameras that the projectors were solved from, which the file did not solve for: what formats of a pair
  /// take where there is no other.
  std::vector<Device> given_cameras{};
  Notes notes{};  ///< what differs from the file, such as a lens that is fitted; empty: nothing
};

}  // namespace laterna
