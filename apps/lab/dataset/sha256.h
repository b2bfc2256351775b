// SHA-256 of bytes (OpenSSL's libcrypto, which uses the processor's instructions for it).
#pragma once

#include <string>
#include <string_view>

namespace laterna {

/// 64 hexadecimal digits, as `sha256sum` prints.
std::string sha256_hex(std::string_view bytes);

}  // namespace laterna
