// One model fitted to a capture: noise levels estimated, outliers named.
#pragma once

#include "calib/boards/adjust.h"

#include <optional>
#include <vector>

namespace laterna {

struct RigFit {
  RigModel model;
  BoardCapture capture;  ///< what was fitted, with the sigmas in use
  Adjustment adjustment;
  std::vector<double> rms_px;    ///< of each device, sqrt(mean(du² + dv²))
  std::vector<double> sigma_px;  ///< of each device, per coordinate, from the residuals
};

/// Adjusts from `start` (fitted_to() the model first). With `estimate_sigma` the sightings' sigmas come from
/// the residuals, σ² = Σ(du² + dv²)/(2n - p) for each device, and the adjustment runs again with them: p
/// counts the device's own free parameters, and for device 0 the poses and the bend too; one with a prior
/// counts by the share that the sightings say of it. All devices share the pooled sigma unless theirs differ
/// by more than a factor of two: residuals are partly the model's error, which is no reason for weights. None
/// where a point lies behind, or no convergence.
std::optional<RigFit> fit_rig(const BoardCapture& capture, const RigModel& model, const BoardRig& start,
                              bool estimate_sigma);

struct Outliers {
  BoardCapture kept;
  std::vector<Sighting> dropped;
  std::vector<double> residual_px;  ///< of the dropped
};

/// Drops what lies beyond `sigmas` under a Cauchy loss: |residual| > sigmas·σ of its device, with σ² =
/// median(du² + dv²)/(2·ln 2), at least `least_sigma_px`; fits again and looks again until nothing more is
/// dropped. None where a fit fails.
std::optional<Outliers> drop_outliers(const BoardCapture& capture, const RigModel& model,
                                      const BoardRig& start, double sigmas, double least_sigma_px = 1e-3);

}  // namespace laterna
