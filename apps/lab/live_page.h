// The live view: a scene as one HTML page that draws it in the browser (WebGL2), with projector and camera to
// move. Its script is apps/live/src, joined into one text by the build.
#pragma once

#include "apps/lab/simulation.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace laterna {

/// What the page draws: matrices_json() of the devices and beside it
///   "name" text, "ambient_lx", "texture_from_clip" 4×4, "left_out": live_omissions();
///   "switches": {"in_front", "back_face", "shadow", "irradiance"}: true or false;
///   "meshes": [{"name", "albedo", "world_from_object": 4×4, "positions": x, y, z, … as 32-bit floats and
///     "triangles": three indices each as 32-bit integers, little endian, in base64}];
/// of each camera "saturation_cd_per_m2": by projector, at which its picture is white (with automatic
/// exposure
///   from the scene's own light);
/// of each projector "flux_lm", "border" and "bilinear": true or false, "patterns": [{"name", "axis": 0 or 1,
///   "values": two hexadecimal digits for each column or row}] of a coded sequence, else empty.
/// One camera sees the light of one projector, which the page lets choose, without lenses and without effects
/// but those switches. Throws InputError where the scene has no camera or no projector.
nlohmann::json live_json(const Scene& scene, const std::string& name);

/// The same with the scene's rays at hand.
nlohmann::json live_json(const Scene& scene, const SceneRays& rig, const std::string& name);

/// The page. Nothing is loaded from elsewhere. Opened with #picture=K, or #picture=K&keys=… after those keys,
/// it holds, in <pre id="picture">, the camera's picture of slide K (0: white; patterns come last): per
/// pixel, row by row, three hexadecimal digits: 1 where lit else 0, and the digital number of 8 bits.
std::string live_page(const nlohmann::json& data);

/// What the page leaves out of this scene, as a sentence; empty: nothing.
std::string live_omissions(const Scene& scene);

}  // namespace laterna
