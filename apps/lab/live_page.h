// The live view: a scene as one HTML page that draws it in the browser (WebGL2), with projector and camera to
// move. Its script is apps/live/src, joined into one text by the build.
#pragma once

#include "sim/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace laterna {

/// What the page draws: matrices_json() of the devices and beside it
///   "name" text, "flux_lm" (of the first projector), "ambient_lx", "saturation_cd_per_m2" (at which the
///   picture is white; with automatic exposure from the scene's own light), "texture_from_clip" 4×4;
///   "switches": {"in_front", "border", "back_face", "shadow", "irradiance", "bilinear"}: true or false;
///   "meshes": [{"name", "albedo", "world_from_object": 4×4, "positions": [x, y, z, …] in single precision,
///     "triangles": [three indices, …]}];
///   "patterns": [{"name", "axis": 0 or 1, "values": two hexadecimal digits for each column or row}] of a
///   coded
///     sequence, else empty.
/// Only the first camera and the first projector are drawn, without lenses and without effects but those
/// switches. Throws InputError where the scene has no camera or no projector.
nlohmann::json live_json(const Scene& scene, const std::string& name);

/// The page. Nothing is loaded from elsewhere. Opened with #picture=K, or #picture=K&keys=… after those keys,
/// it holds, in <pre id="picture">, the camera's picture of slide K (0: white; patterns come last): per
/// pixel, row by row, three hexadecimal digits: 1 where lit else 0, and the digital number of 8 bits.
std::string live_page(const nlohmann::json& data);

/// What the page leaves out of this scene, as a sentence; empty: nothing.
std::string live_omissions(const Scene& scene);

}  // namespace laterna
