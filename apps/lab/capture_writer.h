// Pictures to disk: a whole capture in one folder, self-contained, there only when complete.
#pragma once

#include "apps/lab/simulation.h"
#include "sim/capture_folder.h"
#include "sim/scene_spec.h"

#include <filesystem>
#include <functional>

namespace laterna {

struct CaptureOptions {
  std::uint64_t seed = 1;
  std::string format = "png";  ///< png, tif, pgm, exr or tif-pages; see sim/capture_folder.h
  bool truth = true;           ///< per camera pixel, as multi-layer EXR in single precision
  /// Is shown each view's pictures, indices of camera and projector first, before they are let go.
  std::function<void(int camera, int projector, const CapturedStack&)> on_view{};
};

/// Throws InputError, beginning with `place`, where there is no such format, or it does not hold a camera's
/// numbers.
void check_format(const std::string& format, const Scene& scene, const std::string& place = "--format");

/// Captures every view of a scene into the new folder `target` (sim/capture_folder.h describes it). `folder`
/// is where the scene file stands. Throws InputError where `target` exists or cannot be written; then nothing
/// is left behind.
/// Returns what a person should be warned of (capture_warnings.h); `progress` gets it before the pictures.
std::vector<std::string> write_capture(const SceneSpec& spec, const Scene& scene,
                                       const std::filesystem::path& folder,
                                       const std::filesystem::path& target, const CaptureOptions& options,
                                       StageTimes& times, const Progress& progress = {});

/// The same with the rig at hand, into the folder `root`, which exists and is the caller's to complete. Gives
/// back the manifest that was written.
CaptureManifest fill_capture(const SceneSpec& spec, const Scene& scene, const SceneRays& rig,
                             const std::filesystem::path& folder, const std::filesystem::path& root,
                             const CaptureOptions& options, StageTimes& times, const Progress& progress = {});

/// The same with views that are traced and exposed: the same files, without tracing again what their maps
/// tell.
CaptureManifest fill_capture(const SceneSpec& spec, const Scene& scene, const Traced& traced,
                             const std::filesystem::path& folder, const std::filesystem::path& root,
                             const CaptureOptions& options, StageTimes& times, const Progress& progress = {});

/// One capture for each place of the scene's board (board_places.h), seeds counting up from the options', in
/// `target`/place_00, place_01, .... `target` is there only when all are. Throws InputError as board_places()
/// and write_capture() do.
std::vector<std::string> write_board_captures(const SceneSpec& spec, const std::filesystem::path& folder,
                                              const std::filesystem::path& target, int places,
                                              const CaptureOptions& options, StageTimes& times,
                                              const Progress& progress = {});

}  // namespace laterna
