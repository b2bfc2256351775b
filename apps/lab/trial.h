// The whole round trip as one function: scene → pictures → projector pixels → recovered projector → error
// against the truth.
#pragma once

#include "apps/lab/simulation.h"
#include "apps/lab/told_points.h"
#include "calib/decode.h"
#include "calib/decode_report.h"
#include "calib/solve.h"
#include "calib/verify.h"

#include <functional>

namespace laterna {

struct TrialOptions {
  std::uint64_t seed = 1;
  SolveOptions solve;  ///< lens_model is replaced by each projector's own
  DecodeOptions decode;
  bool known_intrinsics =
      false;             ///< the solver is told the true intrinsics and lens, and finds the placement
  bool true_uv = false;  ///< takes the true (u, v) in double in place of capture and decoding
  int block_px = 32;     ///< side of the camera-image blocks whose errors may be correlated
};

/// How one projector fared.
struct ProjectorOutcome {
  int projector = 0;
  std::string name;
  std::size_t correspondences = 0;
  SolveResult solve;
  Verification verification;            ///< empty sets where refused
  std::vector<float> surface_error_px;  ///< per surface point, in the order of camera pixels of the first
                                        ///< camera, NaN where dark
  std::vector<std::string> flags;       ///< what looks wrong in its pictures, view by view
  std::vector<std::string> doubts;      ///< those that make the verdict at best weak (decode_report.h)
  StageTimes times;                     ///< shared stages (build, surface) included
};

/// Called once per view with the pictures, before they are dropped.
using ViewSink = std::function<void(const View&, const CapturedStack*, const DecodedMap&)>;

/// Adds a view's decoded pixels, with the world points (NaN: none) that the camera's pixels are told to see.
/// Where out.cameras is not empty, `told` must have normals.
void append_correspondences(const DecodedMap& decoded, const ToldPoints& told, int camera, int block_px,
                            Correspondences& out);

/// The true (u, v) of a view as a decoded map, sigma 1e-3 px: for tests of everything but decoding.
DecodedMap true_map(const LightMap& light);

/// The world points of every camera pixel that the projector truly lights, view by view, in the order of
/// pixels.
LargeVector<glm::dvec3> lit_points(const Traced& traced, int projector);

/// Runs the round trip for each projector of the scene, all cameras together. Pictures and the true projector
/// are those of the true meshes and cameras; the world points handed to the solver come from the believed
/// ones. A camera pixel whose believed ray misses the believed meshes gives no correspondence. Throws
/// InputError for a scene without projector or camera; what cannot be recovered ends as a refusal in the
/// outcome.
std::vector<ProjectorOutcome> run_trial(const Scene& scene, const Traced& traced, const TrialOptions& options,
                                        StageTimes& times, const ViewSink& sink = {},
                                        const Progress& progress = {});

/// Exit code for a set of outcomes: 0 ok, 3 where one is refused, else 4 where one is weak.
int exit_code_of(const std::vector<ProjectorOutcome>& outcomes);

}  // namespace laterna
