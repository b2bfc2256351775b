#include "apps/lab/dataset/tar_file.h"

#include "sim/error.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <cerrno>
#include <system_error>

namespace laterna {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, archive* a) {
  const int code = archive_errno(a);
  const char* words = archive_error_string(a);
  throw InputError(fmt::format("{}: cannot be written: {}", path.string(),
                               code > 0 ? std::generic_category().message(code)
                               : words  ? words
                                        : "unknown reason"));
}

}  // namespace

void TarWriter::Close::operator()(archive* a) const { archive_write_free(a); }

TarWriter::TarWriter(const std::filesystem::path& path) : path_(path), archive_(archive_write_new()) {
  constexpr int block_bytes = 1 << 20;  // written at a time
  if (archive_write_set_format_ustar(archive_.get()) != ARCHIVE_OK ||
      archive_write_set_bytes_per_block(archive_.get(), block_bytes) != ARCHIVE_OK ||
      archive_write_open_filename(archive_.get(), path.c_str()) != ARCHIVE_OK)
    fail(path_, archive_.get());
}

void TarWriter::add(const std::string& name, std::string_view bytes) {
  const std::unique_ptr<archive_entry, void (*)(archive_entry*)> entry(archive_entry_new(),
                                                                       &archive_entry_free);
  archive_entry_set_pathname(entry.get(), name.c_str());
  archive_entry_set_size(entry.get(), la_int64_t(bytes.size()));
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_perm(entry.get(), 0644);
  archive_entry_set_mtime(entry.get(), 0, 0);
  if (archive_write_header(archive_.get(), entry.get()) != ARCHIVE_OK) fail(path_, archive_.get());
  if (archive_write_data(archive_.get(), bytes.data(), bytes.size()) != la_ssize_t(bytes.size()))
    fail(path_, archive_.get());
}

void TarWriter::finish() {
  if (archive_write_close(archive_.get()) != ARCHIVE_OK) fail(path_, archive_.get());
}

}  // namespace laterna
