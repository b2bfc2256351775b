// Scene files: TOML that a person can write. data/scene-reference.md lists every key.
#pragma once

#include "sim/scene_build.h"
#include "sim/scene_spec.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace laterna {

/// Reads and checks a scene file without opening the files it names. Throws InputError with one sentence that
/// begins with the file and, where there is one, the line: `scene.toml:12: unknown key "albdo" in [[mesh]],
/// did you mean "albedo"?`. Refused are: files over 16 MiB, text that is no TOML, unknown keys, values of a
/// wrong type, out of range or not finite, and what check() of sim/scene_build.h refuses. Integers stand for
/// numbers where a number is expected.
SceneSpec read_scene_spec(const std::filesystem::path& path);

/// The same from text; `file_name` begins each message.
SceneSpec parse_scene(std::string_view text, const std::string& file_name);

/// The scene as TOML. Fields that equal their default are left out; numbers are written to their last bit:
/// parse_scene(scene_toml(spec), name) == spec for every spec that check() accepts.
std::string scene_toml(const SceneSpec& spec);

/// build_scene(read_scene_spec(path), the file's folder). Messages begin with the file.
Scene load_scene(const std::filesystem::path& path);

}  // namespace laterna
