// What a calibration from boards found, for people.
#pragma once

#include "apps/lab/board_folders.h"
#include "calib/boards/calibrate_boards.h"
#include "calib/peers/board_methods.h"

#include <string>
#include <vector>

namespace laterna {

/// Ladder, parameters with sigmas, poses, how sure the pixels are, verdict.
std::string board_text(const BoardCalibration& calibration);

/// Where boards were found and read, and warnings; empty without either.
std::string placements_text(const BoardFolders& folders);

/// Every method on the same sightings, a line each.
std::string methods_text(const std::vector<MethodResult>& results);

}  // namespace laterna
