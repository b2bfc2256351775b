// What a calibration from boards found, for machines.
#pragma once

#include "apps/lab/board_folders.h"
#include "calib/boards/calibrate_boards.h"
#include "calib/peers/board_methods.h"

#include <nlohmann/json_fwd.hpp>

#include <vector>

namespace laterna {

/// {"status", "reason", "fit_rms_px", "held_out_px": {"rms", "folds": [rms of each pose]}, "cameras":
/// [{"name", "size", "fx", "fy", "cx", "cy", "lens": {"model", "parameters"}, "sigma": {...}, "sigma_px",
/// "fit_rms_px", "coverage", "prediction_sigma_px": [{"range", "center", "rms", "worst"}]}], "projectors":
/// [the same and "device_from_camera": 3×4], "board_bend", "parameters", "covariance" (row-major, in their
/// order), "predicted_volume_px": {"independent", "jackknife", "camera_frame"}, "weakest": {"direction",
/// "sigma", "gap"}, "correlations", "poses", "dropped", "ladder"}. Device 0 is the camera whose frame
/// the others stand in: x_device = R·x_camera + t in the file's unit of length; other cameras have a
/// "device_from_camera" too. Without an estimate the lists are
/// empty and the numbers null; a number that is not finite is null.
nlohmann::json board_json(const BoardCalibration& calibration);

/// Adds "placements": [{"folder", "board", "pose", "points", "projectors": [{"name", "points",
/// "median_residual_px"}]}] and "warnings": [sentence] to what board_json() made.
void add_placements(nlohmann::json& json, const BoardFolders& folders);

/// [{"method", "failure", "fit_rms_px", "held_out_px": {"rms", "folds", "failed"}, "seconds", "over_bound",
/// "projector":
/// {"fx", "fy", "cx", "cy"}}]: every method on the same sightings. over_bound is null where no truth is
/// known.
nlohmann::json methods_json(const std::vector<MethodResult>& results);

}  // namespace laterna
