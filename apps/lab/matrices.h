// A scene's matrices as numbers for machines: what `laterna info --json` prints.
#pragma once

#include "sim/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace laterna {

/// Row-major array of arrays, full double precision.
nlohmann::json json_of(const glm::dmat4& matrix);

/// {"projectors": [...], "cameras": [...]}, each {"name", "size": [W,H], "fx", "fy", "cx", "cy", "lens":
/// {"model", "parameters"}, "texture_from_clip", "clip_from_projector", "projector_from_world",
/// "texture_from_world": 4×4 each}.
nlohmann::json matrices_json(const Scene& scene);

/// The same for people: a table of devices, each with its T.
std::string matrices_text(const Scene& scene);

}  // namespace laterna
