// Cameras that expose as the scene makes them, without rays to find out.
#pragma once

#include "sim/scene.h"
#include "sim/scene_spec.h"

#include <filesystem>
#include <functional>

namespace laterna {

/// Whether some camera exposes automatically and its rows are not those of direct light at pixel centres
/// (rows_are_direct()): then the rows are worked out once for the exposure and once for the pictures.
bool exposure_takes_rays(const Scene& scene);

/// Sets saturation_cd_per_m2 of every camera that exposes automatically, to the largest that it takes for any
/// projector: with one projector, the pictures keep their bits. Does nothing unless exposure_takes_rays().
/// What was found for a scene is kept for the next time that it is asked for. Not for several threads.
std::function<void(SceneSpec&)> fixed_exposure(const std::filesystem::path& folder);

}  // namespace laterna
