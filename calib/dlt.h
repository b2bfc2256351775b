// The linear start: a projector from correspondences without a guess.
#pragma once

#include "calib/correspondences.h"
#include "sim/intrinsics.h"
#include "sim/rigid.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace laterna {

/// ok: every point lies in front. mirrored: the mapping fits, but only with every point behind the projector.
/// both_sides: some in front, some behind. degenerate: the linear system has more than one solution.
enum class DltStatus { ok, degenerate, mirrored, both_sides };

struct DltResult {
  DltStatus status = DltStatus::degenerate;
  std::string reason;  ///< one sentence; empty where ok
  Intrinsics intrinsics;
  Rigid device_from_world;
  double skew_px = 0;       ///< what the linear solution has and a projector has not
  double smallest_gap = 0;  ///< second smallest over largest singular value
  double uniqueness = 0;    ///< smallest over second smallest singular value: 0 for exact data, 1 for none
  double rms_px = 0;        ///< of the linear solution, over all points that it was made from
  std::vector<std::size_t> inliers;  ///< RANSAC only
};

/// The normalised direct linear transform (Hartley and Zisserman, Multiple View Geometry, 2nd ed., algorithm
/// 7.1), rows weighted by 1/sigma: minimises |A·p| with |p| = 1 over p, the 12 entries of the pixel matrix in
/// normalised coordinates. Degenerate where the second smallest singular value is below 1e-11 of the largest,
/// where the smallest is no smaller than half of the second, or where the matrix has no finite centre. At
/// least 6 valid correspondences.
DltResult dlt(const Correspondences& correspondences, glm::ivec2 size);

struct RansacOptions {
  std::uint64_t seed = 1;
  double threshold_sigmas = 6;  ///< an inlier's |residual| is below this
  double confidence = 0.9999;
  int max_trials = 3000;
};

/// DLT on the largest agreeing set: samples of 6 points chosen by a counter-based generator keyed on (seed,
/// trial), scored by the truncated squared residual (MSAC; Torr and Zisserman 2000) on at most 2000 evenly
/// spread points, until a better set is unlikely; then DLT on all inliers, twice. Same answer for the same
/// seed.
DltResult ransac_dlt(const Correspondences& correspondences, glm::ivec2 size,
                     const RansacOptions& options = {});

}  // namespace laterna
