// Pictures and a known scene to projectors: the same for simulated captures and for pictures of a real
// projector.
#pragma once

#include "apps/lab/decode_folder.h"
#include "apps/lab/known_intrinsics.h"
#include "apps/lab/simulation.h"
#include "calib/solve.h"

#include <functional>
#include <string>
#include <vector>

namespace laterna {

/// One projector, from every sequence that shows it.
struct FolderEstimate {
  std::string projector;
  std::size_t correspondences = 0;
  SolveResult solve;
  std::vector<std::string> flags;  ///< what looks wrong in its pictures, sequence by sequence
};

/// Decodes the sequences of a manifest, takes the world point of each camera pixel from the scene's meshes
/// and cameras as they are believed (told_points.h; never from the true ones where `believed` says
/// otherwise), carries the cameras' uncertainty through, and solves for each projector named in the manifest.
/// Of the scene's projectors only the lens model is used, never figures or placement. Where a projector's
/// intrinsics are `known`, only its placement is solved for. Throws InputError where a sequence names a
/// camera that the scene has not, or whose pictures have another size.
std::vector<FolderEstimate> calibrate_folder(const std::filesystem::path& folder,
                                             const CaptureManifest& manifest, const Scene& scene,
                                             const SolveOptions& solve_options,
                                             const DecodeOptions& decode_options,
                                             const KnownByName& known = {}, const Progress& progress = {});

}  // namespace laterna
