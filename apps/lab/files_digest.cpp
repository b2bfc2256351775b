#include "apps/lab/files_digest.h"

#include "apps/lab/dataset/sha256.h"
#include "sim/text_file.h"

#include <algorithm>

namespace laterna {

namespace {

constexpr std::size_t most_bytes = std::size_t{4} << 30;

}  // namespace

std::string files_digest(std::vector<std::filesystem::path> files) {
  if (files.empty()) return "none";
  for (std::filesystem::path& file : files) file = file.lexically_normal();
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  std::string digests;
  for (const std::filesystem::path& file : files) digests += sha256_hex(read_text(file, most_bytes));
  return sha256_hex(digests);
}

}  // namespace laterna
