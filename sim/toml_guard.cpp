#include "sim/toml_guard.h"

#include "sim/error.h"
#include "sim/text_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace laterna {

namespace {

/// The place after the string or comment that begins at `at`.
std::size_t skip_quoted(std::string_view text, std::size_t at) {
  const char quote = text[at];
  if (quote == '#') return std::min(text.find('\n', at), text.size());
  const std::string triple(3, quote);
  const bool many_lines = text.substr(at, 3) == triple;
  for (std::size_t i = at + (many_lines ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (many_lines ? text.substr(i, 3) == triple : text[i] == quote) {
      return i + (many_lines ? 3 : 1);
    } else if (!many_lines && text[i] == '\n') {
      return i;  // an unclosed string, which the parser will say
    }
  }
  return text.size();
}

}  // namespace

void check_toml_bytes(std::string_view text, const std::string& file_name) {
  check_text(text, file_name);
  int depth = 0, dots = 0;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '#' || c == '"' || c == '\'') {
      i = skip_quoted(text, i);
      continue;
    }
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (c == '.') ++dots;
    if (std::string_view(",=[]{}\n").find(c) != std::string_view::npos) dots = 0;
    if (depth > deepest_toml || dots > deepest_toml) {
      const auto line = 1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(i), '\n');
      throw InputError(fmt::format("{}:{}: {} nest deeper than {}, expected a scene", file_name, line,
                                   dots > deepest_toml ? "the parts of a key" : "brackets", deepest_toml));
    }
    ++i;
  }
}

}  // namespace laterna
