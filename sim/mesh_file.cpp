#include "sim/mesh_file.h"

#include "sim/assimp_mesh.h"
#include "sim/error.h"
#include "sim/gzip.h"
#include "sim/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <utility>

namespace laterna {

namespace {

std::string small_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return extension;
}

void expect_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path.string() + ": there is no such file");
  if (std::filesystem::is_directory(status))
    throw InputError(path.string() + ": is a folder, expected a mesh file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(path.string() + ": is no regular file");
  if (!std::ifstream(path)) throw InputError(path.string() + ": cannot be opened for reading");
  if (std::filesystem::file_size(path, error) == 0) throw InputError(path.string() + ": the file is empty");
}

std::string bytes_of(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) throw InputError(path.string() + ": cannot be read");
  std::string bytes(size, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes.data(), std::streamsize(bytes.size())))
    throw InputError(path.string() + ": cannot be read to its end");
  return bytes;
}

/// Assimp takes an IFC file that was cut short as fine.
void expect_whole_ifc(std::string_view bytes, const std::string& name) {
  const std::string_view tail = bytes.substr(bytes.size() - std::min<std::size_t>(bytes.size(), 1024));
  if (tail.find("END-ISO-10303-21") != tail.npos) return;
  throw InputError(name + ": does not end with `END-ISO-10303-21;`: the file is truncated or no IFC file");
}

Mesh read_bytes(std::string_view bytes, const std::string& extension, const std::string& name) {
  if (extension == ".ply") return read_ply(bytes, name);
  if (extension == ".ifc") expect_whole_ifc(bytes, name);
  return read_with_assimp(bytes, extension, name);
}

void expect_known(const std::string& extension, const std::string& name) {
  if (extension == ".ply" || assimp_reads(extension)) return;
  throw InputError(
      fmt::format("{}: the ending `{}` is no mesh format that is known, expected .ply, .obj, .stl, .off, "
                  ".gltf, .glb, .ifc, .dae, .fbx, .3ds or another that Assimp reads, or one of them with "
                  ".gz",
                  name, extension));
}

Mesh read_unvalidated(const std::filesystem::path& path) {
  const std::string name = path.string();
  const std::string ending = small_extension(path);
  const bool packed = ending == ".gz";
  const std::string extension = packed ? small_extension(path.stem()) : ending;
  expect_known(extension, name);
  expect_file(path);
  if (packed) return read_bytes(gunzip(bytes_of(path), name), extension, name);
  // The others may refer to files beside them (glTF to its buffers), so Assimp has to know the path.
  if (extension == ".ply" || extension == ".ifc") return read_bytes(bytes_of(path), extension, name);
  return read_with_assimp(path, extension);
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path) {
  Mesh mesh = read_unvalidated(path);
  validate(mesh, path.string());
  return mesh;
}

double metres_per_unit(const std::string& unit) {
  static constexpr std::pair<std::string_view, double> units[] = {
      {"m", 1.0}, {"mm", 1e-3}, {"cm", 1e-2}, {"km", 1e3}, {"inch", 0.0254}, {"foot", 0.3048}};
  std::string accepted;
  for (const auto& [name, metres] : units) {
    if (unit == name) return metres;
    accepted += fmt::format("{}\"{}\"", accepted.empty() ? "" : ", ", name);
  }
  throw InputError(fmt::format("unit \"{}\" is not known, expected one of {}", unit, accepted));
}

}  // namespace laterna
