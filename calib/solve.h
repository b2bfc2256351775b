// Correspondences to a projector, with its covariance and an honest verdict.
#pragma once

#include "calib/correspondences.h"
#include "calib/robust_loss.h"
#include "sim/device.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace laterna {

/// Intrinsics and lens that are known before any point is seen.
struct KnownIntrinsics {
  Intrinsics intrinsics;
  Lens lens;
  /// Standard deviations of fx, fy, cx, cy (px) and the lens parameters, independent of one another; 0 is
  /// exact (held to 1e-6 px, a lens parameter to 1e-9). Empty: all exact.
  std::vector<double> sigma{};
};

struct SolveOptions {
  /// Its parameters are solved for, from zero; of a splined one the knots, with fx, fy, cx, cy held and a
  /// prior (splined_lens.h), from the lens with k1, k2, p1, p2 that fits best.
  std::string lens_model = "LENSMODEL_PINHOLE";
  RobustLoss loss;            ///< none: every residual is believed
  double tolerance_px = 0.5;  ///< a predicted volume error above it is `weak`
  int max_iterations = 500;
  std::uint64_t seed = 1;       ///< of RANSAC
  std::optional<Device> start;  ///< tried beside the linear starts, unless splined; of the same lens model
  /// The placement alone is asked for: a Gaussian prior on the rest, whose lens model is the one that counts.
  /// Flat scenes will do then.
  std::optional<KnownIntrinsics> known{};
};

/// ok: believe the estimate and its covariance. weak: an estimate exists, but the data do not support it as
/// far as asked; `reason` says why. refused: no estimate.
enum class Status { ok, weak, refused };

struct SolveResult {
  Status status = Status::refused;
  std::string reason;  ///< one sentence, or several joined by "; "; empty where ok
  Device estimate;     ///< intrinsics, pose, lens; meaningless where refused

  /// Tangent parameters: fx, fy, cx, cy (px), lens, rotation (small left rotation vector w in the device
  /// frame, rad: R = exp([w]×)·R̂), translation (m).
  std::vector<std::string> parameter_names;
  /// Row-major p×p. Independent noise: (JᵀWJ)⁻¹ with W = 1/sigma_px², by Ceres.
  std::vector<double> covariance_independent;
  /// Delete-one-cluster jackknife (covariance.h). Empty where a cluster cannot be left out.
  std::vector<double> covariance_clustered;
  /// What the uncertainty of the cameras adds (camera_uncertainty.h). Empty where they are certain.
  std::vector<double> covariance_camera;
  /// The one that `sigma`, the prediction and the verdict use: clustered; with fewer than 3·p clusters the
  /// one of the two that predicts the larger volume error; plus covariance_camera.
  std::vector<double> covariance;
  std::vector<double> sigma;  ///< standard deviation of each parameter
  bool clusters_suffice = false;
  std::size_t clusters = 0;

  int free_parameters =
      0;  ///< that only the points can tell: all that are not held; 6 where the intrinsics are known
  double fit_rms_px = 0;      ///< sqrt(mean(du² + dv²)) over all correspondences
  double reduced_chi2 = 0;    ///< Σ ((du² + dv²)/σ²) / (2n - p)
  double residual_scale = 0;  ///< residuals over what the sigmas explain; with a robust loss by the median
  double outlier_share = 0;   ///< correspondences with (du² + dv²)/σ² > 13.8, where noise leaves 0.1 %
  double predicted_volume_rms_px = 0;              ///< from `covariance`, over the estimate's own volume grid
  double predicted_volume_rms_independent_px = 0;  ///< from `covariance_independent`
  double predicted_volume_rms_camera_px = 0;       ///< from `covariance_camera`
  double expected_camera_chi2 = 0;  ///< what the cameras' uncertainty adds to Σ ((du² + dv²)/σ²)
  double relief_over_throw = 0;     ///< thickness of the points over their distance

  int iterations = 0;
  std::string termination;                     ///< Ceres's own words
  std::vector<double> scaled_singular_values;  ///< of the Jacobian with columns scaled to 1, largest first
  double smallest_gap = 0;                     ///< last over first of them
  std::string weakest_direction;               ///< in words: which parameters trade off
};

/// Maximum likelihood for u, v with Gaussian noise sigma_px (or under `loss`): Ceres from DLT, from RANSAC
/// where a loss is robust or DLT fits badly, and from nominal focal lengths where the relief is thin or the
/// linear starts end badly; the lowest cost wins. Refused: too few, identical, collinear or coplanar points,
/// pixels on a line, a mirrored mapping, points behind the projector, a rank-deficient Jacobian, no
/// convergence. Weak: predicted volume error above the tolerance, residuals over twice what the sigmas
/// explain, too few clusters, sigma of fx or fy above a tenth of it, more outliers than the loss bears (Huber
/// 15 %, Cauchy 50 %), an estimate that cannot map its own volume, or, for a pinhole, residuals that follow a
/// lens (lens_left_out.h, once in 10⁵ by chance) which would move the volume by more than twice its predicted
/// error. The verdict never looks at a truth.
///
/// With known intrinsics: starts by SQPNP (Terzakis and Lourakis, ECCV 2020) and, for coplanar points, both
/// solutions of IPPE (Collins and Bartoli, IJCV 2014), from the inliers of P3P where a loss is robust; 4
/// points suffice and may lie in a plane. Weak also: a second placement that the points cannot tell from the
/// first (Σ ρ(s) within 20).
///
/// The world points are believed. Where their cameras are uncertain, that is carried to first order into
/// covariance, prediction and verdict, and residuals may be as large as it explains. Where they are wrong and
/// nothing says so, what the residuals show ends as weak (a mesh that is noisy, coarse, misplaced or scaled,
/// once the misfit is over twice the sigmas); what they do not show goes into the projector and cannot be
/// told: whole world and camera moved or scaled together, and any error too small for the sigmas.
/// Throws InputError where correspondences, size, lens model or start are malformed.
SolveResult solve(const Correspondences& correspondences, glm::ivec2 projector_size,
                  const SolveOptions& options = {});

/// Adds what else is known to be wrong with the data: `ok` becomes `weak`, refused stays refused, and the
/// sentences are joined to the reason.
void add_doubts(SolveResult& result, const std::vector<std::string>& doubts);

}  // namespace laterna
