// Which sightings cannot be of the point that they are labelled with, and which stations are one.
#pragma once

#include "calib/selfcal/reconstruct.h"

#include <string>
#include <vector>

namespace laterna {

struct DroppedSighting {
  TrackSighting sighting;
  double residual_sigmas = 0;
};

/// Pairs with their geometry; outliers of each pair's epipolar geometry are kept in `geometry.inlier`. With
/// sigmas that are not known, sets them all to the noise that the pairs show, at least 0.01 px: no device
/// measures better. Throws Refusal where a pair has no geometry.
std::vector<SolvedPair> solve_pairs(Tracks& tracks);

/// Takes out of the tracks the sightings that more than half of their pairs disagree with, both where a pair
/// is all there is of a point; and out of the pairs what they disagree with.
std::vector<DroppedSighting> drop_pair_outliers(Tracks& tracks, std::vector<SolvedPair>& pairs);

/// Takes out of the tracks sightings that do not fit a rig: of each point with Σ r² beyond the 1e-5 tail of
/// its law (2s - 3 degrees of freedom, times `variance`) the worst, all of them where two are left. Points
/// that are not placed go too.
std::vector<DroppedSighting> drop_misfits(Tracks& tracks, const TrackRig& rig, double variance);

/// Stations of one device that stand in the same place as far as the others can tell are made one: where they
/// share points, these have the same pixels (rms below 2 sigma); where they do not, the epipolar geometry of
/// one with a common third station is that of the other (rms below twice the noise). Says which, for people,
/// once for each station that is gone. This is what moving the scene alone looks like.
std::vector<std::string> merge_stations(Tracks& tracks);

}  // namespace laterna
