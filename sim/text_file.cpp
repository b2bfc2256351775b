#include "sim/text_file.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <system_error>

namespace laterna {

std::string read_text(const std::filesystem::path& path, std::size_t most_bytes) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw InputError(fmt::format("{}: it is a folder, expected a file", path.string()));
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw InputError(fmt::format("{}: cannot be opened: {}", path.string(),
                                 std::error_code(errno, std::generic_category()).message()));
  }
  std::string text;
  const std::uintmax_t expected_bytes = std::filesystem::file_size(path, ignored);  // fails for a pipe
  if (!ignored && expected_bytes <= most_bytes) text.reserve(expected_bytes);
  char part[65536];
  while (text.size() <= most_bytes && (file.read(part, sizeof part) || file.gcount() > 0))
    text.append(part, std::size_t(file.gcount()));
  if (file.bad()) throw InputError(fmt::format("{}: cannot be read", path.string()));
  if (text.size() > most_bytes) {
    throw InputError(
        fmt::format("{}: it holds more than {} bytes, expected at most that", path.string(), most_bytes));
  }
  return text;
}

void check_text(std::string_view text, const std::string& file_name) {
  using Utf8 = boost::locale::utf::utf_traits<char>;
  int line = 1;
  for (const char* at = text.data(); at != text.data() + text.size();) {
    const boost::locale::utf::code_point c = Utf8::decode(at, text.data() + text.size());
    if (c == boost::locale::utf::illegal || c == boost::locale::utf::incomplete) {
      throw InputError(
          fmt::format("{}:{}: a byte sequence is no UTF-8, expected UTF-8 text", file_name, line));
    }
    const bool line_end = c == '\n' || (c == '\r' && at != text.data() + text.size() && *at == '\n');
    if ((c < 0x20 && c != '\t' && !line_end) || c == 0x7f) {
      throw InputError(
          fmt::format("{}:{}: control character 0x{:02x}, expected text", file_name, line, unsigned(c)));
    }
    line += c == '\n';
  }
}

}  // namespace laterna
