#include "sim/ply_header.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace laterna::ply {

namespace {

constexpr std::array<std::string_view, 8> short_names = {"char", "uchar", "short", "ushort",
                                                         "int",  "uint",  "float", "double"};
constexpr std::array<std::string_view, 8> long_names = {"int8",  "uint8",  "int16",   "uint16",
                                                        "int32", "uint32", "float32", "float64"};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  const char* blanks = " \t";
  for (std::size_t start = line.find_first_not_of(blanks); start != line.npos;
       start = line.find_first_not_of(blanks, start)) {
    const std::size_t end = std::min(line.find_first_of(blanks, start), line.size());
    words.push_back(line.substr(start, end - start));
    start = end;
  }
  return words;
}

/// Walks through the header line by line and fills in what it declares.
class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Header read() {
    if (next_line() != "ply") fail("expected `ply`: this is no PLY file");
    bool has_format = false;
    for (std::string_view line = next_line(); line != "end_header"; line = next_line()) {
      const auto words = words_of(line);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "format") {
        if (has_format) fail("a second `format`, expected one");
        read_format(words);
        has_format = true;
      } else if (words[0] == "element") {
        read_element(words);
      } else if (words[0] == "property") {
        read_property(words);
      } else {
        fail(fmt::format(
            "unknown word `{}`, expected format, element, property, comment, obj_info or end_header",
            shown(words[0])));
      }
    }
    if (!has_format) throw InputError(name_ + ": the PLY header has no `format` line");
    return header_;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}, line {}: {}", name_, header_.line_count, what));
  }

  /// Foreign bytes, cut short and without control characters, fit for a message.
  static std::string shown(std::string_view word) {
    std::string text(word.substr(0, 40));
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 32 || c > 126; }, '?');
    return text;
  }

  std::string_view next_line() {
    const std::size_t start = header_.body_offset;
    const std::size_t end = bytes_.find('\n', start);
    ++header_.line_count;
    if (end == bytes_.npos) {
      if (header_.line_count == 1) fail("expected `ply`: this is no PLY file");
      throw InputError(name_ + ": the PLY header has no `end_header` line");
    }
    header_.body_offset = end + 1;
    std::string_view line = bytes_.substr(start, end - start);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line.substr(0, line.find_last_not_of(" \t") + 1);
  }

  void read_format(const std::vector<std::string_view>& words) {
    if (words.size() != 3 || words[2] != "1.0") fail("expected `format <encoding> 1.0`");
    if (words[1] == "ascii") {
      header_.encoding = Encoding::ascii;
    } else if (words[1] == "binary_little_endian") {
      header_.encoding = Encoding::little_endian;
    } else if (words[1] == "binary_big_endian") {
      header_.encoding = Encoding::big_endian;
    } else {
      fail(fmt::format("unknown encoding `{}`, expected ascii, binary_little_endian or binary_big_endian",
                       shown(words[1])));
    }
  }

  void read_element(const std::vector<std::string_view>& words) {
    if (words.size() != 3) fail("expected `element <name> <count>`");
    Element element{std::string(words[1]), 0, {}};
    const char* end = words[2].data() + words[2].size();
    const auto [rest, error] = std::from_chars(words[2].data(), end, element.count);
    if (error != std::errc{} || rest != end)
      fail(fmt::format("the count is `{}`, expected a whole number from 0", shown(words[2])));
    for (const Element& other : header_.elements) {
      if (other.name == element.name)
        fail(fmt::format("a second element `{}`, expected one", shown(words[1])));
    }
    header_.elements.push_back(std::move(element));
  }

  void read_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("a property before the first element");
    const bool is_list = words.size() > 1 && words[1] == "list";
    if (words.size() != (is_list ? 5U : 3U))
      fail("expected `property <type> <name>` or `property list <count type> <type> <name>`");
    Property property{std::string(words.back()), type_of(words[words.size() - 2]), std::nullopt};
    if (is_list) {
      property.count_type = type_of(words[2]);
      if (!is_integer(*property.count_type)) fail("a list counted in floats, expected an integer type");
    }
    for (const Property& other : header_.elements.back().properties) {
      if (other.name == property.name)
        fail(fmt::format("a second property `{}`, expected one", shown(property.name)));
    }
    header_.elements.back().properties.push_back(std::move(property));
  }

  Type type_of(std::string_view word) const {
    for (std::size_t i = 0; i < short_names.size(); ++i) {
      if (word == short_names[i] || word == long_names[i]) return Type(i);
    }
    fail(fmt::format("unknown type `{}`, expected {} or {}", shown(word), fmt::join(short_names, ", "),
                     fmt::join(long_names, ", ")));
  }

  std::string_view bytes_;
  const std::string& name_;
  Header header_;
};

/// The fewest bytes that one record can have: in text a digit and a blank for each property.
std::size_t least_bytes(const Element& element, Encoding encoding) {
  std::size_t bytes = 0;
  for (const Property& property : element.properties)
    bytes += encoding == Encoding::ascii ? 2 : size_in_bytes(property.count_type.value_or(property.type));
  return bytes;
}

void expect_room(const Header& header, std::size_t size, const std::string& name) {
  // The last line of a text needs no line end.
  std::uint64_t room = size - header.body_offset + (header.encoding == Encoding::ascii ? 1 : 0);
  for (const Element& element : header.elements) {
    const std::uint64_t each = least_bytes(element, header.encoding);
    if (each == 0) continue;
    if (element.count > room / each) {
      throw InputError(
          fmt::format("{}: the header declares {} records of `{}`, at least {} bytes each, but {} bytes "
                      "are left for them: the file is truncated or its header wrong",
                      name, element.count, element.name, each, room));
    }
    room -= element.count * each;
  }
}

}  // namespace

std::size_t size_in_bytes(Type type) {
  constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[std::size_t(type)];
}

Header read_header(std::string_view bytes, const std::string& name) {
  Header header = HeaderReader(bytes, name).read();
  expect_room(header, bytes.size(), name);
  return header;
}

}  // namespace laterna::ply
