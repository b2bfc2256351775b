// Where the parts of a data set stand in its folder.
//
//   DIR/dataset.json                    what the set is: the same for all of its shards
//   DIR/samples/BLOCK/KEY/              one sample: a capture folder (sim/capture_folder.h) with sample.json,
//                                       truth/, mask/ and correspondences/
//   DIR/tars/NAME-BLOCK.tar             the samples of a block, as WebDataset reads them
//   DIR/tars/NAME-BLOCK.json            what it holds: key, checksum, bytes, rejections
//   DIR/runs/I-of-K/                    a shard's journal, lock and cost
//   DIR/checksums.txt, card.md, sample.schema.json   there when the set is whole
//
// A block is `tar_samples` samples in a row, whatever the shards.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>

namespace laterna {

struct DatasetFolder {
  std::filesystem::path root;
  std::string name;
  std::uint64_t count = 0, block_samples = 1;

  std::uint64_t blocks() const { return (count + block_samples - 1) / block_samples; }
  std::uint64_t block_of(std::uint64_t sample) const { return sample / block_samples; }
  std::uint64_t first_of(std::uint64_t block) const { return block * block_samples; }
  std::uint64_t end_of(std::uint64_t block) const { return std::min(count, (block + 1) * block_samples); }

  std::filesystem::path block_folder(std::uint64_t block) const;
  std::filesystem::path sample(std::uint64_t sample) const;
  std::filesystem::path tar(std::uint64_t block) const;
  std::filesystem::path listing(std::uint64_t block) const;
  std::filesystem::path run(int shard, int shards) const;

  /// Whether a sample is made: its folder is there, or its block's tar file.
  bool has(std::uint64_t sample) const;
};

/// Eight digits.
std::string sample_key(std::uint64_t sample);

/// Makes folders, however many. Throws InputError where one cannot be made.
void make_folders(const std::filesystem::path& folder);

/// Holds a file locked (flock) until it goes; the system lets go when the process dies.
class FileLock {
 public:
  enum class Wait { yes, no };
  /// Throws InputError where the file cannot be made, or, without waiting, where another process holds it.
  FileLock(const std::filesystem::path& path, Wait wait);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace laterna
