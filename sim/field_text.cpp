#include "sim/field_text.h"

#include <fmt/format.h>

namespace laterna {

std::string toml_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_not_of("-0123456789") == std::string::npos) text += ".0";
  return text;
}

std::string toml_text(const std::string& value) {
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') {
      text += {'\\', c};
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      text += fmt::format("\\u{:04X}", int(c));
    } else {
      text += c;
    }
  }
  return text + "\"";
}

}  // namespace laterna
