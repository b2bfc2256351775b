// Pictures of a calibration from boards: what was found, and what is left over.
#pragma once

#include "apps/lab/board_folders.h"
#include "calib/boards/calibrate_boards.h"

#include <filesystem>
#include <vector>

namespace laterna {

/// The residuals of a device's sightings over its image, predicted - measured, as strokes that begin at the
/// measured pixel: direction as hue, length `magnification` times as long. Noise shows all hues mixed;
/// neighbours of one hue are a model that does not fit there. `magnification` 0: so that the rms is 1/40 of
/// the image's width.
Image<glm::u8vec3> residual_picture(const BoardCalibration& calibration, int device,
                                    double magnification = 0);

/// The mean picture of a placement with its points: green where every projector's pixel was read, yellow
/// where some were, red where none was; the first point is ringed.
Image<glm::u8vec3> placement_picture(const BoardFolders& folders, const BoardPlacement& placement);

/// Writes residuals_DEVICE.png of every device, unless refused, and found_00.png, found_01.png, ... of every
/// placement. Throws InputError where the folder cannot be made or written to.
void write_board_pictures(const std::filesystem::path& folder, const BoardFolders& folders,
                          const BoardCalibration& calibration);

}  // namespace laterna
