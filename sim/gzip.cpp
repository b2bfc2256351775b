#include "sim/gzip.h"

#include "sim/error.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>

namespace laterna {

namespace {

struct Inflater {
  z_stream stream{};
  Inflater() {
    const int gzip_only = 16 + MAX_WBITS;
    if (inflateInit2(&stream, gzip_only) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
};

/// Unpacks one member from the front of `packed` onto the end of `content`.
void unpack_member(std::string_view& packed, std::string& content, const std::string& name,
                   std::size_t limit_bytes) {
  std::array<char, std::size_t{1} << 16> chunk;
  Inflater inflater;
  z_stream& z = inflater.stream;
  int status = Z_OK;
  while (status != Z_STREAM_END) {
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));  // zlib does not write to it
    z.avail_in = uInt(std::min(packed.size(), chunk.size()));
    z.next_out = reinterpret_cast<Bytef*>(chunk.data());
    z.avail_out = uInt(chunk.size());
    const uInt given = z.avail_in;
    status = inflate(&z, Z_NO_FLUSH);
    packed.remove_prefix(given - z.avail_in);
    content.append(chunk.data(), chunk.size() - z.avail_out);
    if (status == Z_MEM_ERROR) throw std::bad_alloc();
    if (status == Z_BUF_ERROR || (status == Z_OK && packed.empty() && z.avail_out > 0))
      throw InputError(name + ": the gzip stream ends early: the file is truncated");
    if (status != Z_OK && status != Z_STREAM_END)
      throw InputError(
          fmt::format("{}: the gzip stream is corrupt ({})", name, z.msg ? z.msg : "unknown reason"));
    if (content.size() > limit_bytes)
      throw InputError(
          fmt::format("{}: unpacks to more than {} bytes, the most that is read", name, limit_bytes));
  }
}

}  // namespace

std::string gunzip(std::string_view bytes, const std::string& name, std::size_t limit_bytes) {
  std::string content;
  do {
    if (!content.empty() && !bytes.starts_with("\x1f\x8b"))
      throw InputError(fmt::format("{}: {} bytes follow the gzip stream, expected the end of the file", name,
                                   bytes.size()));
    unpack_member(bytes, content, name, limit_bytes);
  } while (!bytes.empty());
  return content;
}

}  // namespace laterna
