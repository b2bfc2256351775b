// Other solvers of the known-geometry problem, behind one signature, for comparison.
#pragma once

#include "calib/solve.h"

#include <string>
#include <vector>

namespace laterna {

/// What a method says; a peer gives no covariance and no verdict but that it answers.
struct PointAnswer {
  Status status = Status::refused;
  std::string reason;  ///< empty where ok
  Device estimate;
  double predicted_px = 0;  ///< its own prediction of the volume error; 0: it makes none
};

/// "laterna": solve(). "dlt": the normalised linear transform alone (dlt.h), pinhole. "opencv":
/// cv::calibrateCamera on one view from a guess of 1.5 widths and the image's middle (clamped into the image,
/// as it demands), until its steps are below 1e-12 or 1000 iterations, with the lens terms of `lens_model`
/// (PINHOLE, OPENCV4 or OPENCV5); what it throws is a refusal.
std::vector<std::string> point_method_names();

/// Throws InputError for an unknown name, malformed correspondences or options, or a lens that "opencv" has
/// not.
PointAnswer solve_points(const std::string& method, const Correspondences& correspondences, glm::ivec2 size,
                         const SolveOptions& options);

}  // namespace laterna
