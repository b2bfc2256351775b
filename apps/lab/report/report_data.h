// What Laterna left in a folder, as the one JSON that a report page draws.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>

namespace laterna {

/// {"format": "laterna-report", "version": 1, "title": name of the folder,
///  "verdicts": [{"of", "status", "reason", "facts": [{"name", "value", "unit"}]}],
///  "views": [{"camera", "projector", "valid_percent", "frames": [{"label", "image"}],
///             "maps": [{"label", "low", "high", "unit", "image"}]}],
///  "figures": {"rig", "points", "residuals", "projections"},  (trial_figures.h)
///  "result", "estimate", "board", "atlas": {"summary", "cells"}, "charts": [], "plans": [], "selfcals": [],
///  "plan_names", "selfcal_names", "atlas_references": [{"name", "summary", "cells"}] (stored_atlas.h)}
///
/// and of these only what is there. Images are data URIs; a cell of the atlas that left a picture has
/// "image". `path` is a folder or one JSON file, and each of these adds to the page: a round trip
/// (result.json, figures.json and the files that it names), a capture (manifest.json; decoded anew, its
/// estimate.json, where there is one, compared with the truth that it holds), a calibration from boards (any
/// *.json by board_json()), an atlas (atlas.json and cells.json), and any number of charts, plans,
/// self-calibrations and stored references (any *.json by chart_json(), chart_reference(), plan_json(),
/// plan_reference(), selfcal_json(), or as data/atlas has them). The files' numbers
/// are taken over as they stand. Throws InputError where the path holds none of these, or one of them is
/// malformed.
nlohmann::json report_data(const std::filesystem::path& path);

}  // namespace laterna
