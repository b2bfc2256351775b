// Are someone's points on the true surface, and if not, why? A point cloud of any scanner against a simulated
// truth.
#pragma once

#include "apps/lab/score/score.h"
#include "apps/lab/score/suspects.h"
#include "sim/formats/point_cloud.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace laterna {

struct CloudScoreOptions {
  std::string frame{};  ///< the device in whose frame the points stand; empty: the scene's world
  std::string camera{}, projector{};  ///< whose pixels the cloud has; empty: the scene's only one
  /// Moves (world) or scales about the world's origin (scale) the cloud, or both, to fit the true points of
  /// its pixels (similarity.h).
  Alignment alignment{};
  double outlier_mm = 0;      ///< points farther from the surface are outliers; 0: by the noise (CloudScore)
  double tolerance_px = 0.1;  ///< an error below it, or below what it spans on the surface, is ok
  std::uint64_t seed = 1;     ///< of the pictures that give the bound
};

/// rms over points of cloud_errors.h; NaN where the cloud has no pixels for it, or nothing predicts it.
struct CloudMeasures {
  double surface_mm = 0, point_mm = 0, projector_px = 0;
};

struct CloudScore {
  /// ok: each error that is known is below max(2·bound, tolerance), the tolerance in mm being tolerance_px
  /// times the mean width of a projector pixel on the lit surface; else weak. A cloud carries the noise of
  /// each point, so that a right one comes near to its bound; a calibration's bound (score.h) is far below
  /// that noise.
  Status status = Status::weak;
  std::size_t points = 0;
  CloudMeasures error{};  ///< over all points, outliers too
  /// The same of what noise alone makes: the scene's pictures, decoded by Laterna and intersected with the
  /// true devices (capture_cloud.h). NaN where the patterns are not coded.
  CloudMeasures bound{};
  double median_mm = 0, p95_mm = 0;  ///< of the distances to the surface
  /// Points farther from the surface than this: as told, else three times the distance below which 95 of 100
  /// points of the bound's cloud lie, or three times the tolerance where that is more.
  double outlier_limit_mm = 0;
  std::size_t outliers = 0;
  std::size_t no_true_point = 0;  ///< points with a pixel that sees no surface
  Alignment alignment{};
  std::string frame{};              ///< as told
  std::vector<Suspect> suspects{};  ///< most likely first, where the status is not ok
  std::string better_frame{};       ///< a device's; with it, and the suspects undone, the points fit
};

/// Scores a cloud. Suspects are those of cloud_undo.h, on up to 500 points, where undoing takes away 0.95 of
/// E, or more than half and leaves less than three times the noise:
///
///   E = mean(min(d, 10·outlier limit)²)/noise_mm² + mean(min(e, 30·noise_px)²)/noise_px²
///
/// each mean over the smaller four fifths, so that outliers hide no mistake, with d the distance to the true
/// point of the camera's pixel, else to the surface, e the projector's error where it is known, and noise the
/// larger of bound and tolerance. Without camera pixels a cloud that undoing leaves less than 0.4 or more
/// than 1.6 times as wide as the lit surface does not count: any surface through the origin is met by a cloud
/// that shrinks onto it. A frame that is not told is looked for where nothing is aligned.
///
/// Throws InputError where a device is not in the scene, or not told and not the only one; where an alignment
/// is asked for and the cloud has no pixels, or too few that see the surface; or where the scene's projectors
/// light nothing that a camera sees.
CloudScore score_cloud(const ScoreTruth& truth, PointCloud cloud, const CloudScoreOptions& options = {},
                       const Progress& progress = {});

/// score_json()'s keys (volume_error_px and predicted_volume_px null, projectors and warnings empty) and
/// "points", "median_mm", "p95_mm", "point_error_mm", "outliers", "outlier_limit_mm", "no_true_point",
/// "frame", "better_frame" (null where there is none).
nlohmann::json cloud_score_json(const CloudScore& score);

/// The same for people.
std::string cloud_score_text(const CloudScore& score);

}  // namespace laterna
