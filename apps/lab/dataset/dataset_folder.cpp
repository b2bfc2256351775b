#include "apps/lab/dataset/dataset_folder.h"

#include "sim/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace laterna {

namespace fs = std::filesystem;

namespace {

std::string block_name(std::uint64_t block) { return fmt::format("{:06}", block); }

}  // namespace

fs::path DatasetFolder::block_folder(std::uint64_t block) const {
  return root / "samples" / block_name(block);
}
fs::path DatasetFolder::sample(std::uint64_t sample) const {
  return block_folder(block_of(sample)) / sample_key(sample);
}
fs::path DatasetFolder::tar(std::uint64_t block) const {
  return root / "tars" / fmt::format("{}-{}.tar", name, block_name(block));
}
fs::path DatasetFolder::listing(std::uint64_t block) const {
  return root / "tars" / fmt::format("{}-{}.json", name, block_name(block));
}
fs::path DatasetFolder::run(int shard, int shards) const {
  return root / "runs" / fmt::format("{}-of-{}", shard, shards);
}

bool DatasetFolder::has(std::uint64_t index) const {
  return fs::exists(sample(index)) || fs::exists(tar(block_of(index)));
}

std::string sample_key(std::uint64_t sample) { return fmt::format("{:08}", sample); }

void make_folders(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw InputError(fmt::format("{}: cannot be made: {}", folder.string(), failed.message()));
}

FileLock::FileLock(const fs::path& path, Wait wait)
    : descriptor_(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  int failed = descriptor_ < 0 ? errno : 0;
  while (!failed && ::flock(descriptor_, LOCK_EX | (wait == Wait::no ? LOCK_NB : 0)) != 0)
    if (errno != EINTR) failed = errno;
  if (!failed) return;
  if (descriptor_ >= 0) ::close(descriptor_);
  throw InputError(
      failed == EWOULDBLOCK
          ? fmt::format("{}: another process is at work here", path.parent_path().string())
          : fmt::format("{}: cannot be locked: {}", path.string(), std::generic_category().message(failed)));
}

FileLock::~FileLock() { ::close(descriptor_); }

}  // namespace laterna
