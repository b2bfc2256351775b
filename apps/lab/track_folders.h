// Capture folders to the table that self-calibration starts from.
#pragma once

#include "calib/selfcal/tracks.h"

#include <filesystem>
#include <string>
#include <vector>

namespace laterna {

struct TrackFolderOptions {
  int stride = 8;  ///< every so many camera pixels, across and down, is a point
  /// The scene moved between folders, the devices did not: points of their own in each folder. Otherwise the
  /// projectors moved, and neither camera nor scene: a camera pixel is one point in all folders.
  bool scene_moved = false;
  double camera_sigma_px =
      0.05;  ///< a point is where a camera pixel's centre looks; what its footprint blurs
};

/// Decodes every sequence of the folders. A camera has one station, "0"; a projector one per folder, "0",
/// "1",
/// ... Pixels that fewer than two devices see give no point. Devices have names and sizes, and no intrinsics.
/// Throws InputError for what manifests and pictures are refused for, a device that changes its size, and a
/// stride below 1.
Tracks tracks_of_folders(const std::vector<std::filesystem::path>& folders,
                         const TrackFolderOptions& options);

}  // namespace laterna
