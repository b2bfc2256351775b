#include "apps/lab/toml_text.h"

#include "sim/error.h"
#include "sim/toml_guard.h"

#include <fmt/format.h>

namespace laterna {

toml::table parse_toml(std::string_view text, const std::string& file) {
  check_toml_bytes(text, file);
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    throw InputError(
        fmt::format("{}:{}: {}", file, error.source().begin.line, std::string(error.description())));
  }
}

}  // namespace laterna
