// Names and words from outside, before they become part of a file's name or a message.
#pragma once

#include <string>

namespace laterna {

/// Throws InputError, beginning with `what`, unless the name is 1 to 64 bytes long, begins with no dot, and
/// holds no slash, backslash or control character: it cannot lead out of a folder.
void check_plain_name(const std::string& name, const std::string& what);

/// Throws InputError, beginning with `what`, unless the path is relative, not empty, and has no part "..".
void check_inner_path(const std::string& path, const std::string& what);

/// A JSON library's message without its own tag in brackets: "[json.exception.x.1] words" becomes "words".
std::string plain_json_message(const std::string& message);

}  // namespace laterna
