// The rig as a still picture: frusta, meshes, lit points, seen askew.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace laterna {

/// "rig" and "points" of report_data()'s figures in parallel projection, from above and beside the devices,
/// upright as the cameras are on the mean. Frusta (without lens distortion) reach to the middle of the
/// points, or of the meshes where there are none; of a mesh at most 3,000 triangles are outlined. A device
/// may have a "colour" of its own.
std::string rig_svg(const nlohmann::json& rig, const nlohmann::json& points);

}  // namespace laterna
