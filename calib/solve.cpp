#include "calib/solve.h"

#include "calib/camera_uncertainty.h"
#include "calib/candidates.h"
#include "calib/covariance.h"
#include "calib/critical_points.h"
#include "calib/lens_left_out.h"
#include "calib/placement.h"
#include "calib/residual_structure.h"
#include "calib/splined_lens.h"
#include "calib/verify.h"
#include "sim/error.h"
#include "sim/spline_knots.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace laterna {

namespace {

constexpr double rank_deficient = 1e-13;      // last over first scaled singular value
constexpr double converged_to_sigmas = 1e-6;  // refine() stops there
constexpr double lens_is_there = 28.5;        // χ² with four degrees of freedom is above it once in 10⁵

SolveResult refused(SolveResult& result, std::string reason) {
  result.status = Status::refused;
  result.reason = std::move(reason);
  return std::move(result);
}

void validate_known(glm::ivec2 size, const KnownIntrinsics& known) {
  validate(known.intrinsics, "known projector");
  if (known.intrinsics.size != size) {
    throw InputError(
        fmt::format("solve: the known intrinsics are of {} × {} px, expected the projector's {} × {}",
                    known.intrinsics.size.x, known.intrinsics.size.y, size.x, size.y));
  }
  const std::size_t k = 4 + std::size_t(lens_parameter_count(known.lens.model));
  if (4 + known.lens.parameters.size() != k || (!known.sigma.empty() && known.sigma.size() != k)) {
    throw InputError(fmt::format(
        "solve: known intrinsics with {} lens parameters and {} sigmas, expected {} and {} for {}",
        known.lens.parameters.size(), known.sigma.size(), k - 4, k, known.lens.model));
  }
  for (const double s : known.sigma)
    if (!(s >= 0) || !std::isfinite(s))
      throw InputError(
          fmt::format("solve: a sigma of the known intrinsics is {}, expected a number from 0", s));
}

void validate_options(glm::ivec2 size, const SolveOptions& options) {
  validate(Intrinsics{size, 1, 1, 0, 0}, "projector");
  if (!(options.tolerance_px > 0)) {
    throw InputError(
        fmt::format("solve: the tolerance is {} px, expected a positive number", options.tolerance_px));
  }
  if (!(options.loss.scale_sigmas > 0)) {
    throw InputError(fmt::format("solve: the robust loss has the scale {} sigmas, expected a positive number",
                                 options.loss.scale_sigmas));
  }
  if (options.known) validate_known(size, *options.known);
  if (!options.start) return;
  validate(*options.start);
  if (options.start->lens.model != (options.known ? options.known->lens.model : options.lens_model)) {
    throw InputError(fmt::format("solve: the start has the lens {}, expected {}", options.start->lens.model,
                                 options.lens_model));
  }
}

Device device_of(const ProjectorState& state, glm::ivec2 size, const std::string& lens_model,
                 const WorldNormalisation& normalisation) {
  const auto& k = state.parameters;
  Device device;
  device.intrinsics = {size, k[0], k[1], k[2], k[3]};
  device.device_from_world = device_from_world(state.device_from_points, normalisation);
  device.lens = {lens_model, {k.begin() + 4, k.end()}};
  return device;
}

void describe_fit(SolveResult& result, const PointTable& points, const LargeVector<double>& s,
                  const RobustLoss& loss) {
  const int p = result.free_parameters;
  double sum = 0, weighted = 0, outliers = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    sum += s[i] / (points.inverse_sigma[i] * points.inverse_sigma[i]);
    weighted += s[i];
    outliers += s[i] > 13.8;
  }
  const double n = double(s.size());
  result.fit_rms_px = std::sqrt(sum / n);
  result.reduced_chi2 = weighted / std::max(1.0, 2 * n - p);
  result.outlier_share = outliers / n;
  result.residual_scale = residual_scale(s, p, loss);
}

// A spline, with its prior put into `points`, from the lens with k1, k2, p1, p2 that fits best.
BestRefinement best_spline(const Correspondences& c, PointTable& points,
                           const WorldNormalisation& normalisation, glm::ivec2 size, const LensGradient& lens,
                           const GeometryReport& geometry, SolveOptions options) {
  const std::string splined_model = std::exchange(options.lens_model, "LENSMODEL_OPENCV4");
  options.start.reset();
  BestRefinement best =
      best_refinement(c, points, normalisation, size, LensGradient(options.lens_model), geometry, options);
  if (!best.refinement) return best;
  const ProjectorState& lean = best.refinement->state;
  const std::vector<double> start =
      spline_like(device_of(lean, size, options.lens_model, normalisation), splined_model);
  points.prior = spline_prior(start);
  best.refinement = refine(points, lens, {start, lean.device_from_points},
                           {options.loss, options.max_iterations, double(std::max(size.x, size.y))});
  if (!best.refinement) best.refusal = "some points lie behind the projector that fits the others";
  return best;
}

// What the points of a solution that is not unique lie on, before the rest of the sentence.
std::string critical_words(std::span<const glm::dvec3> world_points, const GeometryReport& geometry) {
  if (geometry.spread_m.z < 3e-3 * geometry.spread_m.x) return "the points are too flat: ";
  const std::string words = critical_in_words(critical_set(world_points));
  return words.empty() ? words : words + ": ";
}

std::string relief_words(const SolveResult& result) {
  return fmt::format(" (relief {:.2g} % of the throw)", 100 * result.relief_over_throw);
}

// Picks the covariance that the verdict uses, and what it predicts over the estimate's own volume. False
// where the estimate cannot map that volume.
bool predict(SolveResult& result, std::span<const glm::dvec3> world_points) {
  const int p = int(result.parameter_names.size());
  const auto volume = image_grid(result.estimate, volume_depths(depths_of(result.estimate, world_points)));
  const auto prediction = [&](const std::vector<double>& c) {
    return c.empty() ? 0.0 : predicted_rms(result.estimate, c, volume).value_or(INFINITY);
  };
  const double independent = prediction(result.covariance_independent);
  const double clustered = prediction(result.covariance_clustered);
  result.clusters_suffice =
      result.clusters >= 3 * std::size_t(result.free_parameters) && !result.covariance_clustered.empty();
  const bool use_clustered = result.clusters_suffice || clustered > independent;
  result.covariance = use_clustered ? result.covariance_clustered : result.covariance_independent;
  // Residuals near rounding say nothing of where the refinement stopped.
  result.predicted_volume_rms_px =
      std::max(use_clustered ? clustered : independent, converged_to_sigmas * independent);
  if (!result.covariance_camera.empty()) {
    result.predicted_volume_rms_camera_px = prediction(result.covariance_camera);
    for (std::size_t i = 0; i < result.covariance.size(); ++i)
      result.covariance[i] += result.covariance_camera[i];
    result.predicted_volume_rms_px = prediction(result.covariance);
  }
  result.predicted_volume_rms_independent_px = independent;
  for (int i = 0; i < p; ++i) result.sigma.push_back(std::sqrt(std::max(0.0, result.covariance[i * p + i])));
  return volume.size() == std::size_t(16 * 12 * 12);
}

// Everything that makes an estimate weak, in plain sentences.
std::vector<std::string> weaknesses(const SolveResult& r, const Correspondences& c,
                                    const SolveOptions& options, bool maps_its_volume) {
  std::vector<std::string> w;
  const double n = double(c.world_points.size()), p = r.free_parameters;
  const std::string trade =
      fmt::format("{}; the relief is {:.2g} % of the throw", r.weakest_direction, 100 * r.relief_over_throw);
  if (!maps_its_volume) w.push_back("the estimated lens maps no ray to parts of the projector's image");
  if (!(r.predicted_volume_rms_px <= options.tolerance_px)) {
    const std::string from_camera = r.covariance_camera.empty()
                                        ? std::string()
                                        : fmt::format("{:.3g} px of it from the camera's uncertainty; ",
                                                      r.predicted_volume_rms_camera_px);
    w.push_back(
        fmt::format("the predicted volume error of {:.3g} px is above the tolerance of {:.3g} px ({}{})",
                    r.predicted_volume_rms_px, options.tolerance_px, from_camera, trade));
  }
  const auto& k = r.estimate.intrinsics;
  const double focal_share = std::max(r.sigma[0] / k.fx, r.sigma[1] / k.fy);
  if (!(focal_share <= 0.1)) {
    w.push_back(fmt::format(
        "the focal length is known to {:.2g} % only, so that a linearised covariance cannot be believed ({})",
        100 * focal_share, trade));
  }
  const double spare = std::max(1.0, 2 * n - p);
  const double explained = std::sqrt(1 + 5 * std::sqrt(2 / spare) + r.expected_camera_chi2 / spare);
  if (r.residual_scale > 2 * explained) {
    w.push_back(
        fmt::format("the residual rms is {:.2g} times what the sigmas explain: lens distortion, wrong "
                    "mesh or outliers",
                    r.residual_scale));
  }
  const bool robust = options.loss.kind != RobustLoss::Kind::none;
  const double bearable = options.loss.kind == RobustLoss::Kind::huber ? 0.15 : 0.5;
  if (robust && r.outlier_share > bearable)
    w.push_back(fmt::format("{:.0f} % of the correspondences are outliers, more than this loss bears",
                            100 * r.outlier_share));
  if (!r.clusters_suffice && !c.cluster.empty()) {
    w.push_back(
        fmt::format("only {} blocks of the camera image hold correspondences and {} are needed: how far "
                    "errors are correlated cannot be told",
                    r.clusters, 3 * r.free_parameters));
  }
  return w;
}

// Whether a pinhole's residuals follow a lens, in a sentence; empty where they do not, or where it would move
// the volume by no more than twice what is predicted anyway.
std::string lens_weakness(const SolveResult& r, const PointTable& points, const ProjectorState& state,
                          const WorldNormalisation& normalisation, const Correspondences& c,
                          const SolveOptions& options) {
  if (!is_pinhole(r.estimate.lens) || !r.covariance_camera.empty()) return "";
  const auto left =
      lens_left_out(points, state, options.loss, normalisation, r.estimate.intrinsics.size, lens_is_there);
  if (!left || left->wald < lens_is_there) return "";
  const auto volume = image_grid(r.estimate, volume_depths(depths_of(r.estimate, c.world_points)));
  double sum = 0, count = 0;
  for (const glm::dvec2& d : error_vectors(r.estimate, left->device, volume))
    if (std::isfinite(d.x)) sum += glm::dot(d, d), ++count;
  const double moved = std::sqrt(sum / std::max(1.0, count));
  if (moved <= 2 * r.predicted_volume_rms_px) return "";
  return fmt::format(
      "the residuals follow what a pinhole has not: k1 = {:.2g}, k2, p1 and p2 would move the volume by "
      "{:.2g} "
      "px, where {:.2g} px are predicted (a lens that distorts, a wrong mesh or camera)",
      left->device.lens.parameters[0], moved, r.predicted_volume_rms_px);
}

// Whether neighbouring blocks' residuals agree by more than chance, than what is predicted, and than a
// twentieth of the tolerance: the volume error of a wrong mesh or camera was five to ten times what
// neighbours share in every case that was tried, so that what stays below that is no more than half of the
// tolerance. In a sentence, else empty.
std::string structure_weakness(const SolveResult& r, const PointTable& points, const LensGradient& lens,
                               const ProjectorState& state, double tolerance_px) {
  constexpr double by_chance = 5;
  if (!r.covariance_camera.empty()) return "";
  const auto found = residual_structure(points, lens, state);
  if (!found || found->moran_z < by_chance) return "";
  if (found->smooth_rms_px <= std::max(r.predicted_volume_rms_px, tolerance_px / 20)) return "";
  return fmt::format(
      "neighbouring residuals agree ({:.2g} px of them, {:.0f} standard deviations from chance) where the "
      "predicted error is {:.2g} px: a wrong mesh, camera or lens",
      found->smooth_rms_px, found->moran_z, r.predicted_volume_rms_px);
}

}  // namespace

SolveResult solve(const Correspondences& c, glm::ivec2 size, const SolveOptions& options) {
  validate(c);
  validate_options(size, options);
  const std::string& lens_model = options.known ? options.known->lens.model : options.lens_model;
  const LensGradient lens(lens_model);
  const int p = lens.parameter_count() + 6;
  const bool spline = is_splined(lens_model) && !options.known;
  SolveResult result;
  result.free_parameters = options.known ? 6 : spline ? p - 4 : p;
  result.parameter_names = parameter_names(lens.parameter_count() - 4);
  const GeometryReport geometry = check_geometry(c, result.free_parameters);
  if (geometry.verdict != Geometry::sound) return refused(result, geometry.reason);

  const WorldNormalisation normalisation = normalisation_of(c.world_points);
  PointTable points = point_table(c, normalisation);
  if (options.known) points.prior = prior_of(*options.known);
  const BestRefinement best = spline
                                  ? best_spline(c, points, normalisation, size, lens, geometry, options)
                                  : best_refinement(c, points, normalisation, size, lens, geometry, options);
  if (!best.refinement) return refused(result, best.refusal);
  const Refinement& fit = *best.refinement;
  result.iterations = fit.iterations;
  result.termination = fit.termination;
  result.estimate = device_of(fit.state, size, lens_model, normalisation);
  result.relief_over_throw = relief_over_throw(c, geometry, result.estimate.device_from_world);
  const auto squared = squared_residuals(points, lens, fit.state);
  if (!squared) return refused(result, "some points lie behind the projector that fits best");
  describe_fit(result, points, *squared, options.loss);

  const Spectrum spectrum = scaled_spectrum(fit.factor, p);
  result.scaled_singular_values = spectrum.singular_values;
  result.smallest_gap = spectrum.singular_values.back() / spectrum.singular_values.front();
  result.weakest_direction = direction_in_words(spectrum.weakest, result.parameter_names);
  if (!fit.converged) {
    return refused(result, fmt::format("{}the solver did not converge in {} iterations: {}{}",
                                       critical_words(c.world_points, geometry), fit.iterations,
                                       result.weakest_direction, relief_words(result)));
  }
  const auto independent =
      result.smallest_gap > rank_deficient
          ? ceres_covariance(points, lens, fit.state, {options.loss, 0, double(std::max(size.x, size.y))},
                             fit.factor)
          : std::nullopt;
  if (!independent) {
    return refused(result, fmt::format("{}the points do not determine the projector: {}{}",
                                       critical_words(c.world_points, geometry), result.weakest_direction,
                                       relief_words(result)));
  }
  const Rigid& pose = result.estimate.device_from_world;
  result.covariance_independent = world_covariance(*independent, pose, normalisation);
  const auto clustered = clustered_covariance(points, lens, fit.state, options.loss, fit.factor);
  if (clustered) result.covariance_clustered = world_covariance(*clustered, pose, normalisation);
  if (!c.cameras.empty()) {
    const CameraPart part = camera_part(c, normalisation, lens, fit.state, options.loss, fit.factor);
    result.covariance_camera = world_covariance(part.covariance, pose, normalisation);
    result.expected_camera_chi2 = part.expected_chi2;
  }
  result.clusters = points.cluster_count();
  if (!(result.estimate.intrinsics.fx > 0 && result.estimate.intrinsics.fy > 0))
    return refused(result, "the best fit has a negative focal length: the mapping is mirrored");
  const bool maps_its_volume = predict(result, c.world_points);
  auto weak = weaknesses(result, c, options, maps_its_volume);
  for (const std::string& words : {lens_weakness(result, points, fit.state, normalisation, c, options),
                                   structure_weakness(result, points, lens, fit.state, options.tolerance_px)})
    if (!words.empty()) weak.push_back(words);
  if (!best.ambiguity.empty()) weak.push_back(best.ambiguity);
  if (const std::string set = critical_in_words(critical_set(c.world_points)); !weak.empty() && !set.empty())
    weak.push_back(set);
  result.status = weak.empty() ? Status::ok : Status::weak;
  result.reason = fmt::format("{}", fmt::join(weak, "; "));
  return result;
}

void add_doubts(SolveResult& result, const std::vector<std::string>& doubts) {
  if (doubts.empty()) return;
  if (result.status == Status::ok) result.status = Status::weak;
  const char* between = result.reason.empty() ? "" : "; ";
  result.reason += between + fmt::format("{}", fmt::join(doubts, "; "));
}

}  // namespace laterna
