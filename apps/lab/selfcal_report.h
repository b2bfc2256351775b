// What a self-calibration found, for machines and for people.
#pragma once

#include "calib/selfcal/self_calibrate.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace laterna {

/// {"status", "reason", "count": {"given", "needed", "intrinsics", "places"}, "unit": "metre" or "baseline",
/// "unit_baselines": [[station, station]], "fit_rms_px", "residual_scale", "devices": [{"name", "size", "fx",
/// "fy", "cx", "cy", "lens", "sigma"}], "stations": [{"device", "station", "device_from_first": 3×4,
/// "sightings", "fit_rms_px", "predicted_px"}], "points": [[x, y, z]] in the first station's frame, at most
/// 2,000 of them, evenly spread, "parameters", "covariance" (row-major, in their order), "focal_sigma",
/// "lens_sigma" (a share of f at the image's corner), "ladder": [{"added", "terms" (of each device),
/// "solved", "chosen", "fit_rms_px", "held_out_px": {"rms", "folds"}, "gain_over_error"}] (empty but with
/// --lens auto), "weakest": {"direction", "sigma", "gap"}, "merged", "dropped", "iterations", "termination"}.
/// Keys and shapes that board_json() has too mean the same. Where refused, devices and stations are empty; a
/// number that is not finite is null.
nlohmann::json selfcal_json(const SelfCalibration& calibration);

/// The same as a report to read.
std::string selfcal_text(const SelfCalibration& calibration);

}  // namespace laterna
