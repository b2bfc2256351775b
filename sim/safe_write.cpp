#include "sim/safe_write.h"

#include "sim/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace laterna {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const fs::path& path, const std::string& reason) {
  throw InputError(fmt::format("{}: cannot be written: {}", path.string(), reason));
}

std::string reason_of(int error) { return std::generic_category().message(error); }

std::string partial_prefix(const fs::path& path) { return "." + path.filename().string() + ".partial-"; }

fs::path partial_path(const fs::path& path) {
  return path.parent_path() / (partial_prefix(path) + std::to_string(::getpid()));
}

/// A file descriptor that closes itself, and a file beside the final one that removes itself unless kept.
struct TemporaryFile {
  fs::path path;
  int descriptor = -1;

  explicit TemporaryFile(const fs::path& final_path) : path(partial_path(final_path)) {
    std::error_code ignored;
    const fs::file_status status = fs::status(final_path, ignored);
    if (fs::exists(status) && !fs::is_regular_file(status))
      refuse(final_path, "it is there and is no regular file");
    descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor < 0) refuse(final_path, reason_of(errno));
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor >= 0) ::close(descriptor);
    if (!path.empty()) ::unlink(path.c_str());
  }
  int close() { return ::close(std::exchange(descriptor, -1)); }
  void keep() { path.clear(); }
};

/// 0, or the errno of the first write that failed.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(std::size_t(written));
  }
  return 0;
}

/// Whether a file stands in a PendingFolder of this process, which syncs all of its files at the end.
bool is_pending(const fs::path& path) {
  const std::string suffix = ".partial-" + std::to_string(::getpid());
  const fs::path folder = path.parent_path();
  return std::any_of(folder.begin(), folder.end(), [&](const fs::path& part) {
    return part.native().starts_with('.') && part.native().ends_with(suffix);
  });
}

/// Waits until the disk has all, or leaves that to the pending folder; gives the file's size.
std::size_t sync(const TemporaryFile& file, const fs::path& path) {
  struct stat written {};
  if ((!is_pending(path) && ::fsync(file.descriptor) != 0) || ::fstat(file.descriptor, &written) != 0)
    refuse(path, reason_of(errno));
  return std::size_t(written.st_size);
}

void put_in_place(TemporaryFile& file, const fs::path& path) {
  if (file.close() != 0 || ::rename(file.path.c_str(), path.c_str()) != 0) refuse(path, reason_of(errno));
  file.keep();
}

/// Makes the names inside a folder last. Some file systems cannot sync a folder; that is no fault of the
/// files.
void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

/// The same for all files below a folder, whose failures count.
void sync_files(const fs::path& folder, const fs::path& final_path) {
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_symlink()) continue;
    if (entry.is_directory()) sync_folder(entry.path());
    if (!entry.is_regular_file()) continue;
    const int descriptor = ::open(entry.path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (descriptor < 0) refuse(final_path, reason_of(errno));
    const int error = ::fsync(descriptor) == 0 ? 0 : errno;
    ::close(descriptor);
    if (error != 0) refuse(final_path, reason_of(error));
  }
}

bool is_alive(pid_t process) { return ::kill(process, 0) == 0 || errno == EPERM; }

/// True for a partial folder of `final_path` that nobody is filling any more.
bool is_stale(const fs::path& entry, const fs::path& final_path) {
  const std::string name = entry.filename().string(), prefix = partial_prefix(final_path);
  if (!name.starts_with(prefix)) return false;
  pid_t process = 0;
  const char* end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data() + prefix.size(), end, process);
  if (error != std::errc() || stop != end || process <= 0) return false;
  return process == ::getpid() || !is_alive(process);
}

void remove_stale_folders(const fs::path& final_path) {
  std::vector<fs::path> stale;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(final_path.parent_path(), ignored))
    if (entry.is_directory(ignored) && is_stale(entry.path(), final_path)) stale.push_back(entry.path());
  for (const fs::path& folder : stale) fs::remove_all(folder, ignored);
}

/// rename(2) that never replaces; 0 or an errno. rename(2) alone would replace an empty folder.
int rename_to_new(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;  // else: a file system without that flag
  if (fs::exists(fs::symlink_status(to))) return EEXIST;
  return ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

[[noreturn]] void refuse_existing(const fs::path& folder) {
  throw InputError(fmt::format("{} exists already, expected a new folder", folder.string()));
}

}  // namespace

void write_file(const fs::path& path, std::string_view bytes) { write_file(path, {bytes}); }

void write_file(const fs::path& path, std::initializer_list<std::string_view> parts) {
  TemporaryFile file(path);
  std::size_t expected = 0;
  for (const std::string_view bytes : parts) {
    if (const int error = write_all(file.descriptor, bytes)) refuse(path, reason_of(error));
    expected += bytes.size();
  }
  if (const std::size_t arrived = sync(file, path); arrived != expected)
    refuse(path, fmt::format("{} bytes arrived, expected {}", arrived, expected));
  put_in_place(file, path);
}

void write_file(const fs::path& path, const std::function<void(const fs::path&)>& fill) {
  TemporaryFile file(path);
  fill(file.path);
  sync(file, path);
  put_in_place(file, path);
}

PendingFolder::PendingFolder(const fs::path& final_path) {
  std::error_code error;
  final_ = fs::absolute(final_path).lexically_normal();
  if (!final_.has_filename()) final_ = final_.parent_path();  // "DIR/" is "DIR"
  if (fs::exists(fs::symlink_status(final_, error))) refuse_existing(final_path);
  if (!fs::is_directory(final_.parent_path(), error)) {
    throw InputError(fmt::format("{}: its parent folder {} is missing, expected one that exists",
                                 final_path.string(), final_.parent_path().string()));
  }
  remove_stale_folders(final_);
  const fs::path temporary = partial_path(final_);
  if (::mkdir(temporary.c_str(), 0777) != 0) refuse(final_, reason_of(errno));
  temporary_ = temporary;
}

PendingFolder::~PendingFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

void PendingFolder::commit() {
  sync_files(temporary_, final_);
  sync_folder(temporary_);
  const int error = rename_to_new(temporary_, final_);
  if (error == EEXIST || error == ENOTEMPTY) refuse_existing(final_);
  if (error != 0) refuse(final_, reason_of(error));
  temporary_.clear();
  sync_folder(final_.parent_path());
}

}  // namespace laterna
