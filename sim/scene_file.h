// Scene files: TOML that a person can write. data/scene-reference.md lists every key.
#pragma once

#include "sim/scene_build.h"
#include "sim/scene_spec.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace laterna {

/// Reads and checks a scene file without opening the files it names. Throws InputError with one sentence that
/// begins with the file and, where there is one, the line: `scene.toml:12: unknown key "albdo" in [[mesh]],
/// did you mean "albedo"?`. Refused are: files over 16 MiB, text that is no TOML, unknown keys, values of a
/// wrong type, out of range or not finite, and what check() of sim/scene_build.h refuses. Integers stand for
/// numbers where a number is expected.
SceneSpec read_scene_spec(const std::filesystem::path& path);

/// The same from text; `file_name` begins each message.
SceneSpec parse_scene(std::string_view text, const std::string& file_name);

/// The same with some keys set to other values after the text is read, in order: "KEY=VALUE" with a TOML
/// value and a path of keys and indices joined by dots, as "ambient_lx=3", "projector.0.fx=1500.0" or
/// "camera.sensor.bit_depth=12"; where an index is left out, it is 0. Tables on the way are made where they
/// are not there, entries of arrays are not. Throws InputError that begins with `--set KEY: ` for an override
/// that is no such text, meets no table on its way, or sets what a file could not say.
SceneSpec parse_scene(std::string_view text, const std::string& file_name,
                      const std::vector<std::string>& overrides);
SceneSpec read_scene_spec(const std::filesystem::path& path, const std::vector<std::string>& overrides);

/// The scene as TOML. Fields that equal their default are left out; numbers are written to their last bit:
/// parse_scene(scene_toml(spec), name) == spec for every spec that check() accepts.
std::string scene_toml(const SceneSpec& spec);

/// build_scene(read_scene_spec(path, overrides), the file's folder). Messages begin with the file.
Scene load_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});

}  // namespace laterna
