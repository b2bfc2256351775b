// Unpacks gzip files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace laterna {

/// More than this is refused: a small file can unpack to anything.
constexpr std::size_t unpacked_limit_bytes = std::size_t(4) << 30;

/// The content of a gzip file (RFC 1952, one member or several), checked against its checksums. Throws
/// InputError, beginning with `name`, where the stream is corrupt, ends early, is followed by other bytes, or
/// holds more than `limit_bytes`.
std::string gunzip(std::string_view bytes, const std::string& name,
                   std::size_t limit_bytes = unpacked_limit_bytes);

}  // namespace laterna
