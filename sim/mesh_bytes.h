// What reading a mesh file begins with, whoever understands its bytes.
#pragma once

#include <filesystem>
#include <string>

namespace laterna {

struct MeshEnding {
  std::string extension;  ///< in small letters with its dot, without a last .gz: ".obj"
  bool packed = false;    ///< whether a .gz stood behind it
};
MeshEnding mesh_ending(const std::filesystem::path& path);

/// Throws InputError, beginning with the path, where it is not a regular file that can be opened, or is
/// empty.
void expect_mesh_file(const std::filesystem::path& path);

/// The file's bytes, unpacked where it is packed (gunzip's messages and limit). Throws InputError where they
/// cannot be read.
std::string unpacked_bytes(const std::filesystem::path& path, bool packed);

}  // namespace laterna
