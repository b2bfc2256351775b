// Mesh formats that the Assimp library reads. Only the mesh reader's own process links it (mesh_reader.cpp).
#pragma once

#include "sim/mesh.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace laterna {

/// Whether Assimp has a reader for the extension, in small letters with its dot: ".obj".
bool assimp_reads(const std::string& extension);

/// Reads a mesh file and what it refers to. Throws InputError where Assimp refuses it. Not validated, except
/// that each index lies within its own part.
Mesh read_with_assimp(const std::filesystem::path& path, const std::string& extension);

/// The same from bytes in memory; what the file refers to is not found. `name` begins each message.
Mesh read_with_assimp(std::string_view bytes, const std::string& extension, const std::string& name);

}  // namespace laterna
