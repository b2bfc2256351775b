#include "apps/lab/files_digest.h"

#include "apps/lab/dataset/sha256.h"
#include "sim/error.h"
#include "sim/text_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <set>

namespace laterna {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_bytes = std::size_t{4} << 30;

fs::path whole(const fs::path& path) { return fs::absolute(path.empty() ? "." : path).lexically_normal(); }

[[noreturn]] void fail(const std::string& file, const char* what, const fs::path& run) {
  throw InputError(
      fmt::format("{}: {} {} was begun, expected the same files to go on with it", file, what, run.string()));
}

}  // namespace

std::vector<FileDigest> file_digests(const std::vector<fs::path>& files, const fs::path& folder) {
  std::vector<FileDigest> digests;
  std::set<fs::path> seen;
  for (const fs::path& file : files)
    if (seen.insert(whole(file)).second)
      digests.push_back({file.lexically_normal(),
                         whole(file).lexically_proximate(whole(folder)).generic_string(),
                         sha256_hex(read_text(file, most_bytes))});
  return digests;
}

nlohmann::json json_of(const std::vector<FileDigest>& files) {
  nlohmann::json json = nlohmann::json::object();
  for (const FileDigest& digest : files) json[digest.name] = digest.sha256;
  return json;
}

void expect_unchanged(const std::vector<FileDigest>& files, const nlohmann::json& there,
                      const fs::path& run) {
  for (const FileDigest& digest : files)
    if (there.contains(digest.name) && there[digest.name] != digest.sha256)
      fail(digest.file.string(), "has changed since", run);
  const nlohmann::json here = json_of(files);
  for (const FileDigest& digest : files)
    if (!there.contains(digest.name)) fail(digest.file.string(), "was not named when", run);
  for (const auto& [name, sha256] : there.items())
    if (!here.contains(name)) fail(name, "is not named any more, as it was when", run);
}

}  // namespace laterna
