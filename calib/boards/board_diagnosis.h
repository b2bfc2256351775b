// What a capture of boards can tell and what it cannot, in numbers and in words.
#pragma once

#include "calib/boards/held_out.h"
#include "calib/boards/rig_covariance.h"

#include <optional>
#include <string>
#include <vector>

namespace laterna {

/// One pose of the board.
struct PoseDiagnosis {
  int label = 0;                       ///< the file's own number
  std::vector<std::size_t> sightings;  ///< of each device
  std::vector<double> fit_rms_px;      ///< of each device
  double distance = 0;                 ///< of the board's middle from the camera, in the capture's unit
  double tilt_deg = 0;                 ///< between the board's normal and the camera's axis
  /// How far leaving this pose out moves the pixels that a projector predicts, rms over its volume, the
  /// greatest of all projectors; none where there is no solution without it.
  std::optional<double> leverage_px;
};

/// How sure the pixels of a device are at one range.
struct RangeSigma {
  double range = 0;      ///< axial depth in the capture's unit
  double center_px = 0;  ///< sqrt(trace of the covariance) in the middle of the image
  double rms_px = 0;     ///< over 16×12 pixels of the whole image
  double worst_px = 0;   ///< of them
};

struct DeviceDiagnosis {
  double coverage = 0;             ///< share of 8×6 cells of the image with a sighting in them
  std::vector<RangeSigma> ranges;  ///< nearest, middle and farthest board point, and 1000 times the farthest
};

struct Diagnosis {
  std::vector<PoseDiagnosis> poses;
  std::vector<DeviceDiagnosis> devices;
  double tilt_spread_deg = 0;  ///< largest angle between the normals of two boards

  /// The volume of a projector: 16×12 pixels of its whole image × 12 depths over 5-95 % of its
  /// sightings'. The greatest of all projectors, here and below.
  double predicted_volume_rms_px = 0;  ///< by the covariance, which takes noise as independent
  /// Delete-one-pose jackknife of the same: sqrt((K-1)/K·Σ_k leverage_k²). It sees what the boards' poses
  /// have in common too: correlated noise, a bent board, a lens that is modelled too simply. None where a
  /// pose cannot be left out.
  std::optional<double> jackknife_volume_rms_px;
  /// As predicted_volume_rms_px, of points that are fixed in the camera's frame instead of on the boards
  /// (pixel_covariance_in_camera()): what a comparison with a truth in the camera's frame will find.
  double predicted_volume_camera_frame_rms_px = 0;
  bool maps_its_volume = true;  ///< the lens gives every pixel of the image a ray

  /// The weakest direction in natural units (shares of the focal length, radians, shares of the distance,
  /// lens parameters as they are): its standard deviation, and which parameters it is made of.
  double weakest_sigma = 0;
  std::string weakest_direction;
  std::vector<std::string> correlations;  ///< "projector cy and projector k1 correlate 0.98", the strongest
  double smallest_gap = 0;                ///< last over first singular value of the scaled columns
};

/// `covariance` and `held_out` belong to the fit.
Diagnosis diagnose(const RigFit& fit, const RigCovariance& covariance, const HeldOut& held_out);

/// How far another rig of the same devices, lenses and poses puts a projector's pixels elsewhere over its
/// volume, rms, the greatest of all projectors (rig_covariance.h: carried_pixel()). None where a point ends
/// up behind.
std::optional<double> volume_distance_px(const RigFit& fit, const BoardRig& other);

/// The weakest direction of an eliminated factor, and its standard deviation (infinite where singular).
struct WeakestDirection {
  double sigma = 0;
  std::string words;
  double smallest_gap = 0;
};
WeakestDirection weakest_direction(const RigFit& fit, const std::vector<double>& eliminated_factor);

/// The capture that would determine what a direction in words leaves open.
std::string cure_for(const std::string& weakest_direction);

}  // namespace laterna
