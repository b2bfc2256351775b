// Words for commands that a report suggests.
#pragma once

#include <string>

namespace laterna {

/// In single quotes, whatever is in it, for a POSIX shell.
std::string shell_word(const std::string& word);

/// A name for a folder: letters, digits, dots; anything else becomes one dash. `otherwise` where none is
/// left.
std::string folder_name(const std::string& label, const std::string& otherwise);

}  // namespace laterna
