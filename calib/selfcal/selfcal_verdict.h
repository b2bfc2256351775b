// Why a self-calibration is refused or weak, in words.
#pragma once

#include "calib/selfcal/self_calibrate.h"

#include <string>
#include <vector>

namespace laterna {

/// A homography explains the pair: a plane, or no baseline.
std::string homography_reason(const Tracks& tracks, const SolvedPair& pair);

/// What leaves a solution that cannot be believed; empty where nothing does.
std::string refusal_reason(const SelfCalibration& calibration, const std::vector<SolvedPair>& pairs,
                           const SelfCalibrationOptions& options);

/// Every pair's points lie on a quadric through both centres (critical_pair.h); empty where one pair's do
/// not.
std::string critical_reason(const Tracks& tracks, const std::vector<SolvedPair>& pairs);

/// What makes a solution weak, of `sightings` given ones; several joined by "; ", empty where nothing does.
std::string weakness_reason(const SelfCalibration& calibration, const std::vector<SolvedPair>& pairs,
                            const SelfCalibrationOptions& options, std::size_t sightings);

}  // namespace laterna
