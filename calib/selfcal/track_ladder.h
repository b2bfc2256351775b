// The least lenses that self-calibration supports: terms climb in one at a time, by the rule of
// lens_ladder.h.
#pragma once

#include "calib/boards/lens_ladder.h"
#include "calib/selfcal/adjust_tracks.h"

#include <string>
#include <vector>

namespace laterna {

/// One set of lenses that was tried.
struct TrackRung {
  std::vector<std::vector<std::string>> terms;  ///< of each device; those that do not climb have none
  std::string added;                            ///< "projector k1"; empty for the first
  bool solved = false;                          ///< it, and every fold of it
  bool chosen = false;                          ///< the climb went through it
  double fit_rms_px = 0;                        ///< sqrt(mean(du² + dv²)) over the sightings
  HeldOut held_out;                             ///< held_out_points.h
  double gain_over_error = 0;                   ///< lens_ladder.h: paired_gain_over_error()
};

struct TrackLadder {
  std::vector<TrackRung> rungs;  ///< in the order in which they were tried; empty where no device climbs
  std::size_t winner = 0;
};

/// Gives the devices that climb (TrackDevice::lens_climbs) the terms that forecast points better which were
/// left out, in `tracks` and `rig`, which is adjusted with them. At most 1000 points, evenly spread, are
/// used. A model is tried only where the count allows it (count.h) and pixels determine every parameter.
TrackLadder climb_lenses(Tracks& tracks, TrackRig& rig, const std::vector<UnitBaseline>& units,
                         const RobustLoss& loss, const LadderOptions& options = {});

/// About `wanted` points, evenly spread, with all their sightings.
Tracks some_points(const Tracks& tracks, std::size_t wanted);

}  // namespace laterna
