// Whether files are still what they were.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace laterna {

/// A file that results depend on.
struct FileDigest {
  std::filesystem::path file;
  std::string name;    ///< as seen from a folder, so that both may be moved together
  std::string sha256;  ///< of its bytes
};

/// The digests of files in their order, each once, with names as seen from `folder`. Throws InputError where
/// one cannot be read.
std::vector<FileDigest> file_digests(const std::vector<std::filesystem::path>& files,
                                     const std::filesystem::path& folder);

/// {name: sha256}.
nlohmann::json json_of(const std::vector<FileDigest>& files);

/// Throws InputError, naming the first file that is not as `there` says, json_of() of the same files when
/// `run` (a journal) was begun; what `there` has beside them was a file that is not named any more.
void expect_unchanged(const std::vector<FileDigest>& files, const nlohmann::json& there,
                      const std::filesystem::path& run);

}  // namespace laterna
