// Small text files, read whole and with care.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace laterna {

/// The bytes of a file, a pipe or a terminal. Throws InputError, beginning with the path, where it cannot be
/// opened or read, is a folder, or holds more than `most_bytes`.
std::string read_text(const std::filesystem::path& path, std::size_t most_bytes);

/// Throws InputError, beginning with `file_name` and the line, where the text is not UTF-8, or holds a
/// control character other than tab, line feed and carriage return before it.
void check_text(std::string_view text, const std::string& file_name);

}  // namespace laterna
