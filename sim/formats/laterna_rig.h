// Laterna's own files as rigs: the devices of a scene, and estimates.
//
//   scene.toml   the true devices (believed values are not looked at); data/scene-reference.md
//   *.json       what `laterna calibrate -o` writes of a known scene ("projectors": [{name, size, fx, fy, cx,
//   cy, lens:
//                {model, parameters}, device_from_world: 3 rows of 4, status}]) or of boards ("cameras" at
//                the origin, "projectors" with device_from_camera), what `laterna roundtrip` writes as
//                result.json (each projector's "estimate"), and what laterna_rig_text() writes
//
// Conventions are those of rig.h; lengths in metres.
#pragma once

#include "sim/formats/parts.h"

#include <filesystem>
#include <string>

namespace laterna {

/// The devices of a scene file; meshes and pictures are not opened. Throws InputError as scene_file.h says.
Rig read_scene_rig(const std::filesystem::path& path);

/// A scene with these devices and, since a rig has no surface, a plane of 4 m × 4 m that stands 2 m before
/// the first, which a note says.
std::string scene_rig_text(const Rig& rig, Notes& notes);

bool is_laterna_json(const Tree& tree);

/// What was refused is left out. Throws InputError, beginning with `file_name` and the key.
Rig parse_laterna_json(const std::string& text, const std::string& file_name);

/// {"format": "laterna-estimate", "version": 1, "cameras": [...], "projectors": [...]}, each without
/// covariance.
std::string laterna_json_text(const Rig& rig);

}  // namespace laterna
