// What is checked of a TOML text before a parser sees it.
#pragma once

#include <string>
#include <string_view>

namespace laterna {

/// How deep brackets may nest, and how many dots one key may hold. A scene needs four and none.
inline constexpr int deepest_toml = 64;

/// Throws InputError, beginning with `file_name` and the line, unless the text is UTF-8 without control
/// characters, and neither brackets nor dotted keys nest deeper than deepest_toml: TOML parsers recurse over
/// both, and run out of stack.
void check_toml_bytes(std::string_view text, const std::string& file_name);

}  // namespace laterna
