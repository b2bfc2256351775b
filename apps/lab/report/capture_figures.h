// Pictures and maps for a page: from a capture folder, or as a round trip stored them.
#pragma once

#include "calib/decoded_map.h"
#include "sim/pattern_sequence.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace laterna {

/// "views" of report_data() from what a round trip stored: {"camera", "projector", "projector_size",
/// "decoded": file, "frames": [{"label", "file"}]}, files relative to the folder. Throws InputError where a
/// path leads out of the folder or a file cannot be read.
nlohmann::json stored_view(const std::filesystem::path& folder, const nlohmann::json& view);

/// Adds "views" of a capture folder, "figures" where it holds its scene, and "estimate" where it holds an
/// estimate.json by `laterna calibrate`; residuals and projections where truth is there too. Throws
/// InputError for a malformed manifest, scene or estimate, and for pictures that are missing.
void add_capture(const std::filesystem::path& folder, nlohmann::json& data);

/// [{"label", "low", "high", "unit", "image"}]: columns and rows over the projector's size, and the standard
/// deviation up to its 99th percentile.
nlohmann::json map_figures(const DecodedMap& map, glm::ivec2 projector_size);

}  // namespace laterna
