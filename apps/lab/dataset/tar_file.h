// Tar files that are the same bytes whenever and by whomever they are made.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct archive;

namespace laterna {

/// Writes a POSIX ustar file (libarchive): plain files of mode 0644, owner and time 0, in the order given.
class TarWriter {
 public:
  /// Throws InputError where the file cannot be made.
  explicit TarWriter(const std::filesystem::path& path);
  /// Throws InputError where the name does not fit ustar, or writing fails.
  void add(const std::string& name, std::string_view bytes);
  /// Throws InputError where writing fails; without it the file is not whole.
  void finish();

 private:
  struct Close {
    void operator()(archive* a) const;
  };
  std::filesystem::path path_;
  std::unique_ptr<archive, Close> archive_;
};

}  // namespace laterna
