// The best refinement over all sensible starts.
#pragma once

#include "calib/dlt.h"
#include "calib/geometry_check.h"
#include "calib/refine.h"
#include "calib/solve.h"

#include <optional>
#include <string>

namespace laterna {

struct BestRefinement {
  std::optional<Refinement> refinement;
  std::string refusal;    ///< why there is none
  std::string ambiguity;  ///< another placement that the points cannot tell from it, in a sentence
};

/// Where residuals stand against the sigmas: sqrt(Σs/(2n - p)), or with a robust loss sqrt(median(s)/(2·ln
/// 2)), the median of s being 2·ln 2 for Gaussian noise. 1 is noise alone.
double residual_scale(LargeVector<double> squared_residuals, int parameter_count, const RobustLoss& loss);

/// Refines from every start that solve() describes; of more than 40,000 points, that many choose the start.
/// `points` are the correspondences in normalised coordinates; with a prior, placements alone are sought.
BestRefinement best_refinement(const Correspondences& correspondences, const PointTable& points,
                               const WorldNormalisation& normalisation, glm::ivec2 size,
                               const LensGradient& lens, const GeometryReport& geometry,
                               const SolveOptions& options);

}  // namespace laterna
