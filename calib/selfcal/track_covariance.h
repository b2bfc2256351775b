// How sure a self-calibrated rig is.
#pragma once

#include "calib/selfcal/track_rig.h"

#include <optional>
#include <string>
#include <vector>

namespace laterna {

/// Of the global columns with every unit baseline held at 1, points eliminated: the Cramér-Rao bound where
/// the sigmas are true.
struct TrackCovariance {
  std::vector<double> global;     ///< row-major count²
  std::vector<double> step;       ///< of Gauss and Newton, the points moving along: 0 at an optimum
  double smallest_gap = 0;        ///< last over first singular value of the scaled columns
  double weakest_sigma = 0;       ///< of the weakest direction: shares of f, radians, shares of the baseline
  std::string weakest_direction;  ///< in words
};

/// `variance` multiplies the sightings' own. `global` and `step` are empty where the gap is 1e-10 or less:
/// the pixels do not determine every parameter; the rest still stands, with an infinite sigma.
TrackCovariance track_covariance(const Tracks& tracks, const TrackRig& rig,
                                 const std::vector<UnitBaseline>& units, double variance);

/// rms over the placed points of sqrt(trace) of the covariance of the pixel at which a station sees them,
/// when a point is given in the first station's frame, in baselines.
double predicted_px(const Tracks& tracks, const TrackRig& rig, const std::vector<double>& covariance,
                    int station);

/// A distance between two points, known in metres.
struct KnownLength {
  int point_a = 0, point_b = 0;
  double metres = 0;
};

/// Gives a rig its size: translations and points in metres, and the covariance with them: the error of the
/// two points' distance in the pixels is carried on to all translations. None where a point is not placed.
bool scale_to(const KnownLength& length, const Tracks& tracks, double variance, TrackRig& rig,
              std::vector<double>& covariance);

}  // namespace laterna
