#include "sim/plain_name.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace laterna {

namespace {

bool is_control(unsigned char c) { return c < 0x20 || c == 0x7f; }

}  // namespace

void check_plain_name(const std::string& name, const std::string& what) {
  const bool plain = !name.empty() && name.size() <= 64 && name.front() != '.' &&
                     name.find_first_of("/\\") == std::string::npos &&
                     std::none_of(name.begin(), name.end(), is_control);
  if (plain) return;
  std::string shown = name.substr(0, 64);
  std::replace_if(shown.begin(), shown.end(), is_control, '?');
  throw InputError(fmt::format(
      "{}: name is \"{}\", expected 1 to 64 characters without slashes, control characters or a dot in front",
      what, shown));
}

void check_inner_path(const std::string& path, const std::string& what) {
  const std::filesystem::path parsed(path);
  const bool inner =
      !path.empty() && parsed.is_relative() && std::find(parsed.begin(), parsed.end(), "..") == parsed.end();
  if (!inner)
    throw InputError(fmt::format("{}: found the path \"{}\", expected one inside the folder", what, path));
}

std::string plain_json_message(const std::string& message) {
  const auto end = message.find("] ");
  return message.starts_with("[json.exception") && end != std::string::npos ? message.substr(end + 2)
                                                                            : message;
}

}  // namespace laterna
