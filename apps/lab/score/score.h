// Is someone's calibration right, and if not, why? A result of any tool against a simulated truth.
#pragma once

#include "apps/lab/score/score_rig.h"
#include "apps/lab/score/suspects.h"
#include "apps/lab/simulation.h"
#include "calib/solve.h"
#include "sim/capture_folder.h"
#include "sim/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace laterna {

/// What a result is held against.
struct ScoreTruth {
  Scene scene;
  std::filesystem::path folder{};  ///< of a capture; empty: the scene alone
  CaptureManifest manifest{};      ///< of that folder
};

/// A scene file, or a capture folder with its scene and pictures. Throws InputError for anything else.
ScoreTruth read_score_truth(const std::filesystem::path& path);

/// What a result's file may leave unsaid is what the truth says: the sizes of the first camera and projector.
RigReadOptions unsaid_by(const Scene& truth);

struct ScoreOptions {
  /// None: `world` where the result has a camera (a calibrator's world is its own, most often the camera),
  /// else `none`: Laterna's own estimates stand in the scene's world.
  std::optional<Alignment> alignment{};
  double tolerance_px = 0.1;  ///< an error below it is ok whatever the bound
  std::uint64_t seed = 1;     ///< of the trial that gives the bound
};

/// One projector's. Errors are rms over the points of calib/verify.h, in pixels of the true projector, each
/// no larger than its picture's diagonal (probe.h).
struct ProjectorScore {
  std::string name;
  /// ok: both errors, and the camera's, are below max(5·bound, tolerance), or below the tolerance where the
  /// trial that gives the bound is not ok itself; else weak. The surface's bound is the camera's.
  Status status = Status::refused;
  double surface_error_px = 0, volume_error_px = 0;
  /// rms over the surface points of the distance between the point and the result's ray of the true pixel:
  /// how far light that is meant for the point misses it.
  double surface_error_mm = 0;
  /// Of the result's camera over the same surface (camera_score.h); NaN where it has none.
  double camera_error_px = 0;
  /// What noise alone predicts for the best use of this scene's pictures: of Laterna's own decoding and solve
  /// of a trial (trial.h), from its covariance. NaN where the scene's patterns are not coded or the trial was
  /// refused.
  double surface_bound_px = 0, volume_bound_px = 0;
  double predicted_volume_px = 0;  ///< what the result's own covariance predicts; NaN without one
  Alignment alignment{};
  /// Most likely first: of geometry, where the status is not ok, and of pictures, where they are there. A
  /// gamma that left the result ok is not named.
  std::vector<Suspect> suspects{};
};

/// Scores each projector of the result that the scene has: the one of its name, or the only one on either
/// side. Pictures are those of the capture folder; of a scene alone, those that the trial takes. A picture
/// that the folder's manifest lists and that is not there is a dropped frame. Throws InputError where names
/// do not match or the scene's projector lights nothing that a camera sees. A result without projectors (all
/// were refused) gives a refused score for each of the scene's, errors NaN, with the pictures' suspects.
std::vector<ProjectorScore> score(const ScoreTruth& truth, const ScoreResult& result,
                                  const ScoreOptions& options = {}, const Progress& progress = {});

/// {"status", "surface_error_px", "volume_error_px", "surface_error_mm", "camera_error_px", "suspects":
/// [{"name", "explains"}], "bound": {"surface_px", "volume_px"}, "predicted_volume_px", "alignment"} of the
/// projector with the largest volume error, and "projectors": the same of each with "name". Numbers that are
/// not known are null. "warnings": those given, such as the notes of the result's rig.
nlohmann::json score_json(const std::vector<ProjectorScore>& scores, const Notes& warnings = {});

/// The same for people, with a sentence on what to change.
std::string score_text(const std::vector<ProjectorScore>& scores);

}  // namespace laterna
