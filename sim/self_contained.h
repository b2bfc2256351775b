// Copies of a scene that stand elsewhere: one that needs no other file, one that finds the files again.
#pragma once

#include "sim/scene.h"
#include "sim/scene_spec.h"

#include <filesystem>
#include <vector>

namespace laterna {

/// Writes scene.toml into the existing folder `target`, with all that it refers to beside it: meshes as
/// binary PLY under meshes/, pictures under maps/ and camera models under cameramodels/, both byte for
/// byte. `target` can then be moved, and its scene is built from the same bits. `scene` is build_scene(spec,
/// folder). Gives back what scene.toml says. Throws InputError where a file cannot be read or written.
SceneSpec write_self_contained(const SceneSpec& spec, const Scene& scene, const std::filesystem::path& folder,
                               const std::filesystem::path& target);

/// The specification with relative file names, which are looked for in `folder`, turned so that they are
/// found from the folder `target`. Absolute names stay.
SceneSpec seen_from(SceneSpec spec, const std::filesystem::path& folder, const std::filesystem::path& target);

/// Every file that the specification names: meshes, pictures and camera models, relative names in `folder`.
std::vector<std::filesystem::path> files_of(SceneSpec spec, const std::filesystem::path& folder);

}  // namespace laterna
