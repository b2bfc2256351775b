// Unpacks gzip files.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace laterna {

/// More than this is refused: a small file can unpack to a thousand times its size. 512 MiB, or 64 times the
/// file where that is more, up to 4 GiB.
constexpr std::size_t unpacked_limit_bytes(std::size_t packed_bytes) {
  return std::clamp(64 * packed_bytes, std::size_t(512) << 20, std::size_t(4) << 30);
}

/// The content of a gzip file (RFC 1952, one member or several), checked against its checksums. Throws
/// InputError, beginning with `name`, where the stream is corrupt, ends early, is followed by other bytes, or
/// holds more than `limit_bytes`.
std::string gunzip(std::string_view bytes, const std::string& name, std::size_t limit_bytes);

/// The same with the limit of unpacked_limit_bytes().
inline std::string gunzip(std::string_view bytes, const std::string& name) {
  return gunzip(bytes, name, unpacked_limit_bytes(bytes.size()));
}

}  // namespace laterna
