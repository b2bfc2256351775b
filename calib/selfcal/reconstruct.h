// Start values: placements and points from pairs, for intrinsics that are guessed.
#pragma once

#include "calib/selfcal/pair.h"
#include "calib/selfcal/track_rig.h"

#include <optional>
#include <vector>

namespace laterna {

/// A pair whose outliers are gone, with its geometry.
struct SolvedPair {
  StationPair pair;
  PairGeometry geometry;
};

/// A rig with guessed intrinsics, and the baselines that were given length 1 in the order in which stations
/// were placed: the first is that of the pair that was placed first.
struct Reconstruction {
  TrackRig rig;
  std::vector<UnitBaseline> units;
};

/// The pair that tells the most: by √n times the homography's misfit.
const SolvedPair& strongest_pair(const std::vector<SolvedPair>& pairs);

/// How far the pairs are from being those of devices with these intrinsics: rms over the pairs of
/// (s_1 - s_2)/(s_1 + s_2) of the singular values of K_bᵀ·F·K_a, which are equal for an essential matrix.
double essential_misfit(const std::vector<SolvedPair>& pairs, const Tracks& tracks,
                        const std::vector<Intrinsics>& devices);

/// Different guesses worth trying, best first by essential_misfit, at most `most`: focal lengths of 0.4 to 6
/// image widths, Bougnoux's of each pair, and principal points in the middle and half an image above and
/// below.
std::vector<std::vector<Intrinsics>> intrinsics_guesses(const std::vector<SolvedPair>& pairs,
                                                        const Tracks& tracks, std::size_t most);

/// Pose of the strongest pair from its essential matrix (the one of four with most points in front), then
/// station by station by resection from the points at hand (cv::solvePnPRansac; 6 or more), or from a pair
/// with a placed station, whose baseline is then a unit of its own; points by linear triangulation. Points
/// that come to lie behind are not placed. None where a station cannot be placed.
std::optional<Reconstruction> reconstruct(const std::vector<SolvedPair>& pairs, const Tracks& tracks,
                                          const std::vector<Intrinsics>& devices);

/// Triangulates the points that are not placed (linear); those that come to lie behind a station stay so.
void place_missing_points(const Tracks& tracks, TrackRig& rig);

}  // namespace laterna
