// Board correspondences to a camera and projectors, with the least lens model, honest sigmas and a verdict.
#pragma once

#include "calib/boards/board_diagnosis.h"
#include "calib/boards/lens_ladder.h"
#include "calib/solve.h"

#include <optional>
#include <string>
#include <vector>

namespace laterna {

struct BoardOptions {
  /// Distortion terms of each device (rig.h: lens_terms()). Empty: the ladder climbs.
  std::vector<std::vector<std::string>> terms;
  LadderOptions ladder;            ///< also holds bend, one_focal_length and fixed_center
  bool estimate_sigma = true;      ///< sigmas from the residuals; false: those of the capture are believed
  double drop_beyond_sigmas = 20;  ///< outliers (drop_outliers()); 0: none are dropped
  double tolerance_px = 1;         ///< a predicted volume error above it is `weak`
};

struct BoardCalibration {
  Status status = Status::refused;
  std::string reason;  ///< one sentence, or several joined by "; "; empty where ok

  Ladder ladder;                ///< its fit is the estimate; empty where refused before the first rung
  std::vector<Device> devices;  ///< device_from_world is device_from_camera; lengths in the capture's unit
  std::vector<std::string> parameter_names;  ///< rig.h: column_names()
  std::vector<double> sigma;                 ///< of each, by the covariance
  RigCovariance covariance;
  Diagnosis diagnosis;
  std::vector<Sighting> dropped;             ///< outliers
  std::vector<std::string> dropped_devices;  ///< of each, its device's name,
  std::vector<int> dropped_poses;            ///< the file's number of its pose,
  std::vector<double> dropped_residual_px;   ///< and |residual| under the model that found it
  std::vector<int> unused_poses;  ///< labels of poses that every camera sees fewer than 4 corners of

  double fit_rms_px() const;        ///< of all projectors, sqrt(mean(du² + dv²))
  const HeldOut& held_out() const;  ///< of the winning rung; without folds where there is none
};

/// Devices whose intrinsics are known are only placed; where all are, one pose of a flat board will do, and a
/// second placement that the sightings cannot tell from the first (solve.h) is weak.
///
/// The joint maximum-likelihood adjustment of everything (adjust.h) from starts of its own (rig_start.h),
/// after dropping gross outliers under a model with k1, k2, p1, p2 and bend, with the lens model named or the
/// one that the ladder picks.
///
/// Refused: no start, one pose of a flat board, a solver that does not converge, parameters that the
/// sightings do not determine, a device with a focal length that is not positive. Weak, each with the capture
/// that would cure it: fewer than three poses (nothing can be held out), boards nearly parallel (all normals
/// within 10°), no solution without one of the poses, a predicted volume error (covariance or jackknife over
/// poses, whichever is larger) above the tolerance, a focal length known to 2 % only, a held-out rms above
/// three times the fit's, a bend left out by order that the residuals follow, more than 5 % outliers,
/// residuals over twice the believed sigmas, a lens that maps no ray to parts of the image, a spline whose
/// prediction over its own image is above the tolerance. The verdict never
/// looks at a truth. Throws InputError for a malformed capture.
BoardCalibration calibrate_boards(const BoardCapture& capture, const BoardOptions& options = {});

/// Makes ok weak and joins the reasons: what is known of the capture beside its sightings.
void add_doubts(BoardCalibration& calibration, const std::vector<std::string>& doubts);

}  // namespace laterna
