#include "calib/placement.h"

#include <algorithm>

namespace laterna {

// Exact values get sigmas far below what pixels tell and far above rounding.
IntrinsicsPrior prior_of(const KnownIntrinsics& known) {
  constexpr double exact_px = 1e-6, exact_lens = 1e-9;
  IntrinsicsPrior prior{state_of(Device{"", known.intrinsics, {}, known.lens, {}}).parameters, {}};
  for (std::size_t i = 0; i < prior.mean.size(); ++i) {
    const double sigma = known.sigma.empty() ? 0 : known.sigma[i];
    prior.inverse_sigma.push_back(1 / std::max(sigma, i < 4 ? exact_px : exact_lens));
  }
  return prior;
}

BestRefinement place(const Correspondences& c, const KnownIntrinsics& known, const RobustLoss& loss) {
  const GeometryReport geometry = check_geometry(c, 6);
  if (geometry.verdict != Geometry::sound) return {std::nullopt, geometry.reason, {}};
  const WorldNormalisation normalisation = normalisation_of(c.world_points);
  PointTable points = point_table(c, normalisation);
  points.prior = prior_of(known);
  SolveOptions options;
  options.known = known;
  options.loss = loss;
  BestRefinement best = best_refinement(c, points, normalisation, known.intrinsics.size,
                                        LensGradient(known.lens.model), geometry, options);
  if (best.refinement) {
    Rigid& placed = best.refinement->state.device_from_points;
    placed = device_from_world(placed, normalisation);
  }
  return best;
}

}  // namespace laterna
