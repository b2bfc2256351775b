#include "sim/mesh_bytes.h"

#include "sim/error.h"
#include "sim/gzip.h"

#include <fstream>

namespace laterna {

namespace {

std::string small_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return extension;
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

}  // namespace

MeshEnding mesh_ending(const std::filesystem::path& path) {
  const std::string last = small_extension(path);
  if (last == ".gz") return {small_extension(path.stem()), true};
  return {last, false};
}

void expect_mesh_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path.string() + ": there is no such file");
  if (std::filesystem::is_directory(status))
    throw InputError(path.string() + ": is a folder, expected a mesh file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(path.string() + ": is no regular file");
  if (!std::ifstream(path)) throw InputError(path.string() + ": cannot be opened for reading");
  if (std::filesystem::file_size(path, error) == 0) throw InputError(path.string() + ": the file is empty");
}

std::string unpacked_bytes(const std::filesystem::path& path, bool packed) {
  std::string bytes = bytes_of(path);
  return packed ? gunzip(bytes, path.string()) : bytes;
}

}  // namespace laterna
