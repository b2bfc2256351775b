#include "apps/lab/dataset/block.h"

#include "apps/lab/dataset/sha256.h"
#include "apps/lab/dataset/tar_file.h"
#include "sim/error.h"
#include "sim/safe_write.h"
#include "sim/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace laterna {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t most_bytes = std::size_t(1) << 33;

bool is_whole(const DatasetFolder& folder, std::uint64_t block) {
  for (std::uint64_t k = folder.first_of(block); k < folder.end_of(block); ++k)
    if (!fs::exists(folder.sample(k))) return false;
  return true;
}

std::vector<std::string> files_of(const fs::path& root) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(root))
    if (entry.is_regular_file()) names.push_back(entry.path().lexically_relative(root).generic_string());
  std::sort(names.begin(), names.end());
  return names;
}

Json rejected_of(const std::string& record) { return Json::parse(record).at("rejected"); }

/// Adds a sample to the tar file, and says what it is.
Json pack_sample(const fs::path& root, const std::string& key, TarWriter& tar) {
  std::string sums;
  std::size_t bytes = 0;
  Json sample{{"key", key}};
  const std::vector<std::string> names = files_of(root);
  for (const std::string& name : names) {
    const std::string content = read_text(root / name, most_bytes);
    std::string flat = name;
    std::replace(flat.begin(), flat.end(), '/', '.');
    tar.add(key + "." + flat, content);
    sums += sha256_hex(content) + "  " + name + "\n";
    bytes += content.size();
    if (name == "sample.json") sample["rejected"] = rejected_of(content);
  }
  sample["sha256"] = sha256_hex(sums), sample["bytes"] = bytes, sample["files"] = names.size();
  return sample;
}

void pack(const DatasetFolder& folder, std::uint64_t block) {
  write_file(folder.tar(block), [&](const fs::path& temporary) {
    TarWriter tar(temporary);
    Json listing = Json::array();
    for (std::uint64_t k = folder.first_of(block); k < folder.end_of(block); ++k)
      listing.push_back(pack_sample(folder.sample(k), sample_key(k), tar));
    tar.finish();
    write_file(folder.listing(block), listing.dump(1) + "\n");
  });
}

}  // namespace

bool pack_if_whole(const DatasetFolder& folder, std::uint64_t block, bool keep_folders) {
  try {
    if (!fs::exists(folder.tar(block))) {
      if (!is_whole(folder, block)) return false;
      const FileLock lock(folder.block_folder(block) / ".lock", FileLock::Wait::yes);
      if (!fs::exists(folder.tar(block))) pack(folder, block);
    }
  } catch (const std::exception&) {
    if (!fs::exists(folder.tar(block))) throw;  // else another process packed it, and removed the folders
  }
  std::error_code ignored;  // another process may be at it
  if (!keep_folders) fs::remove_all(folder.block_folder(block), ignored);
  return true;
}

Json read_listing(const DatasetFolder& folder, std::uint64_t block) {
  const fs::path path = folder.listing(block);
  const Json listing = Json::parse(read_text(path, most_bytes), nullptr, false);
  if (!listing.is_array() || listing.size() != folder.end_of(block) - folder.first_of(block))
    throw InputError(fmt::format("{}: no listing of {} samples", path.string(),
                                 folder.end_of(block) - folder.first_of(block)));
  return listing;
}

}  // namespace laterna
