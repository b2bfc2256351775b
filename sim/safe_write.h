// The one way in which files are left on disk: whole, or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string_view>

namespace laterna {

/// Leaves exactly `bytes` under `path`. They go to a temporary file beside it (`.NAME.partial-PID`) first;
/// every write, fsync and close is checked, and so is the size; then the file is renamed, so that a reader
/// sees the old file or the new one and never a part. Throws InputError, naming the path and the system's
/// reason ("No space left on device"), and leaves no temporary file, where any of that fails or where `path`
/// is there and is no regular file. In a PendingFolder of this process the fsync is left to commit().
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// The same of bytes in several parts, one after the other.
void write_file(const std::filesystem::path& path, std::initializer_list<std::string_view> parts);

/// The same for a library that writes a file itself: `fill` is given the temporary file's path, and throws
/// where it fails.
void write_file(const std::filesystem::path& path,
                const std::function<void(const std::filesystem::path& temporary)>& fill);

/// A folder that appears under its final name only when it is whole.
///
/// It is filled under a temporary name beside the final one (`.NAME.partial-PID`); commit() renames it, and
/// the destructor removes what was not committed. What a dead process left for the same final name is removed
/// at the start. Within one process, one PendingFolder at a time may prepare a final name.
class PendingFolder {
 public:
  /// Throws InputError where `final_path` is there already, where its parent is no folder, or where the
  /// temporary folder cannot be made.
  explicit PendingFolder(const std::filesystem::path& final_path);
  ~PendingFolder();
  PendingFolder(const PendingFolder&) = delete;
  PendingFolder& operator=(const PendingFolder&) = delete;

  /// Where to put the files until commit().
  const std::filesystem::path& path() const { return temporary_; }

  /// Waits until the disk has every file (fsync of each, when all are written: one by one as they come, they
  /// would wait for the disk's journal again and again), then gives the folder its final name. Throws
  /// InputError where the disk fails, or where that name has come to exist meanwhile: nothing is ever
  /// replaced. At most once.
  void commit();

 private:
  std::filesystem::path final_, temporary_;
};

}  // namespace laterna
