#include "calib/candidates.h"

#include "calib/starts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace laterna {

namespace {

constexpr double thin_relief = 1e-2;          // third over first spread
constexpr double good_residual_scale = 3;     // above it, other starts are tried too
constexpr std::size_t trial_points = 1000;    // for nominal starts
constexpr std::size_t enough_points = 40000;  // to choose among starts

struct Context {
  const Correspondences& correspondences;
  const PointTable& points;
  const WorldNormalisation& normalisation;
  glm::ivec2 size;
  const LensGradient& lens;
  RefineOptions refine;
};

// Evenly spread points of a table; clusters are of no interest to it.
PointTable thinned(const PointTable& points, std::size_t wanted) {
  PointTable t;
  for (const std::size_t i : evenly_spread(points.size(), wanted)) {
    t.x.push_back(points.x[i]), t.y.push_back(points.y[i]), t.z.push_back(points.z[i]);
    t.u.push_back(points.u[i]), t.v.push_back(points.v[i]);
    t.inverse_sigma.push_back(points.inverse_sigma[i]);
  }
  t.cluster_begin = {0, t.x.size()};
  t.prior = points.prior;
  return t;
}

void keep_better(std::optional<Refinement>& best, std::optional<Refinement> candidate) {
  if (!candidate) return;
  if (!best || (candidate->converged && !best->converged) ||
      (candidate->converged == best->converged && candidate->loss < best->loss))
    best = std::move(candidate);
}

ProjectorState start_of(const DltResult& linear, const Context& c) {
  const auto& k = linear.intrinsics;
  ProjectorState start{{k.fx, k.fy, k.cx, k.cy},
                       device_from_normalised(linear.device_from_world, c.normalisation)};
  start.parameters.resize(c.lens.parameter_count(), 0.0);
  return start;
}

double rms_sigma_px(const Correspondences& c) {
  double sum = 0;
  for (const double s : c.sigma_px) sum += 2 * s * s;
  return std::sqrt(sum / double(c.sigma_px.size()));
}

// A linear solution that fits well and clearly, but not in front of the projector.
bool clearly_impossible(const DltResult& linear, const Context& c) {
  if (linear.status != DltStatus::mirrored && linear.status != DltStatus::both_sides) return false;
  const bool most = linear.inliers.empty() || 2 * linear.inliers.size() > c.points.size();
  return most && linear.uniqueness < 0.1 && linear.rms_px < 5 * rms_sigma_px(c.correspondences);
}

// Focal guesses on a thinned table, a wide robust loss first; the two best of them then see all points.
void try_nominal(const Context& c, const std::vector<std::size_t>& inliers, std::optional<Refinement>& best) {
  const PointTable trial = thinned(c.points, trial_points);
  const PointTable posing =
      inliers.empty() ? trial : point_table(subset(c.correspondences, inliers), c.normalisation);
  std::vector<Refinement> ends;
  for (const auto& start : nominal_starts(posing, c.size, c.lens.parameter_count() - 4)) {
    RefineOptions options = c.refine;
    options.max_iterations = std::min(options.max_iterations, 200);
    options.loss.scale_sigmas *= 30;
    std::optional<Refinement> end = refine(trial, c.lens, start, options);
    if (end && c.refine.loss.kind != RobustLoss::Kind::none) {
      options.loss = c.refine.loss;
      end = refine(trial, c.lens, end->state, options);
    }
    if (end) ends.push_back(std::move(*end));
  }
  std::stable_sort(ends.begin(), ends.end(),
                   [](const Refinement& a, const Refinement& b) { return a.loss < b.loss; });
  for (std::size_t k = 0; k < std::min<std::size_t>(2, ends.size()); ++k)
    keep_better(best, refine(c.points, c.lens, ends[k].state, c.refine));
}

bool ends_well(const std::optional<Refinement>& end, const Context& c) {
  if (!end || !end->converged) return false;
  const auto s = squared_residuals(c.points, c.lens, end->state);
  return s && residual_scale(*s, c.lens.parameter_count() + 6, c.refine.loss) < good_residual_scale;
}

// Another end with nearly as little loss, turned against the best by more than its points could hide.
std::string ambiguity_of(const Refinement& best, const std::vector<Refinement>& ends, const Context& c) {
  constexpr double alike = 20, apart_rad = 1e-3;  // e^10 in likelihood
  const auto s = squared_residuals(c.points, c.lens, best.state);
  const double scale = s ? residual_scale(*s, 6, c.refine.loss) : 1;
  for (const Refinement& end : ends) {
    const glm::dmat3 turn =
        end.state.device_from_points.rotation * glm::transpose(best.state.device_from_points.rotation);
    const double angle = glm::length(rotation_vector_rad(turn));
    if (!end.converged || angle < apart_rad || end.loss > best.loss + alike * std::max(1.0, scale * scale))
      continue;
    return fmt::format(
        "another placement, turned by {:.2g} deg, explains the points as well: a deeper scene, or pixels "
        "over more of the image, would tell them apart",
        angle * 180 / std::numbers::pi);
  }
  return "";
}

BestRefinement best_placement(const Context& c, const KnownIntrinsics& known, const GeometryReport& geometry,
                              const SolveOptions& options) {
  ProjectorState state = state_of(Device{"", known.intrinsics, {}, known.lens, {}});
  const bool coplanar = geometry.spread_m.z < thin_relief * geometry.spread_m.x;
  auto starts = placement_starts(c.points, state, LensProjection(known.intrinsics, known.lens), coplanar,
                                 c.refine.loss.kind != RobustLoss::Kind::none);
  if (options.start) {
    state.device_from_points = device_from_normalised(options.start->device_from_world, c.normalisation);
    starts.push_back(state);
  }
  std::vector<Refinement> ends;
  std::optional<Refinement> best;
  for (const ProjectorState& start : starts) {
    const auto end = refine(c.points, c.lens, start, c.refine);
    if (!end) continue;
    ends.push_back(*end);
    keep_better(best, end);
  }
  if (!best) return {std::nullopt, "no placement of the known projector has all points in front of it", {}};
  return {best, {}, ambiguity_of(*best, ends, c)};
}

}  // namespace

double residual_scale(LargeVector<double> s, int parameter_count, const RobustLoss& loss) {
  if (loss.kind != RobustLoss::Kind::none) {
    std::nth_element(s.begin(), s.begin() + s.size() / 2, s.end());
    return std::sqrt(s[s.size() / 2] / (2 * std::numbers::ln2));
  }
  double sum = 0;
  for (const double x : s) sum += x;
  return std::sqrt(sum / std::max(1.0, 2.0 * double(s.size()) - parameter_count));
}

BestRefinement best_refinement(const Correspondences& correspondences, const PointTable& points,
                               const WorldNormalisation& normalisation, glm::ivec2 size,
                               const LensGradient& lens, const GeometryReport& geometry,
                               const SolveOptions& options) {
  if (points.size() > enough_points) {
    const Correspondences few =
        subset(correspondences, evenly_spread(correspondences.world_points.size(), enough_points));
    PointTable table = point_table(few, normalisation);
    table.prior = points.prior;
    BestRefinement best = best_refinement(few, table, normalisation, size, lens, geometry, options);
    if (!best.refinement || !best.refinement->converged) return best;
    best.refinement = refine(points, lens, best.refinement->state,
                             {options.loss, options.max_iterations, double(std::max(size.x, size.y))});
    if (!best.refinement) best.refusal = "some points lie behind the projector that fits the others";
    return best;
  }
  const Context c{correspondences,
                  points,
                  normalisation,
                  size,
                  lens,
                  {options.loss, options.max_iterations, double(std::max(size.x, size.y))}};
  if (options.known) return best_placement(c, *options.known, geometry, options);
  std::optional<Refinement> best;
  if (options.start) {
    ProjectorState start = state_of(*options.start);
    start.device_from_points = device_from_normalised(start.device_from_points, normalisation);
    keep_better(best, refine(points, lens, start, c.refine));
  }
  const bool robust = options.loss.kind != RobustLoss::Kind::none;
  std::vector<DltResult> linear = {dlt(correspondences, size)};
  if (robust || linear[0].status != DltStatus::ok || linear[0].rms_px > 10 * rms_sigma_px(correspondences)) {
    RansacOptions ransac;
    ransac.seed = options.seed;
    linear.push_back(ransac_dlt(correspondences, size, ransac));
  }
  for (const auto& result : linear) {
    if (clearly_impossible(result, c)) return {std::nullopt, result.reason, {}};
    if (result.status == DltStatus::ok)
      keep_better(best, refine(points, lens, start_of(result, c), c.refine));
  }
  const bool thin = geometry.spread_m.z < thin_relief * geometry.spread_m.x;
  if (thin || !ends_well(best, c)) try_nominal(c, linear.back().inliers, best);
  if (best) return {std::move(best), {}, {}};
  const std::string& why = linear.front().reason;
  return {std::nullopt,
          "no start keeps all points in front of the projector" + (why.empty() ? why : ": " + why),
          {}};
}

}  // namespace laterna
