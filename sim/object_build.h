// From a [[mesh]] to an object that can be rendered.
#pragma once

#include "sim/image_file.h"
#include "sim/scene.h"
#include "sim/scene_spec.h"

#include <filesystem>
#include <map>
#include <memory>
#include <utility>

namespace laterna {

/// Albedo maps by file and encoding, so that meshes share them.
using AlbedoMaps = std::map<std::pair<std::filesystem::path, Encoding>, std::shared_ptr<const Image<float>>>;

/// The object with its mesh and maps, files looked for in `folder`; see build_scene() for what is refused.
Object build_object(const MeshSpec& spec, const std::filesystem::path& folder, AlbedoMaps& maps);

}  // namespace laterna
