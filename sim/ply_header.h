// The header of a PLY file. Only sim/ply.cpp and sim/formats/point_cloud.cpp need it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace laterna::ply {

enum class Encoding { ascii, little_endian, big_endian };
enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_in_bytes(Type type);
inline bool is_integer(Type type) { return type < Type::float32; }

struct Property {
  std::string name;
  Type type{};                     ///< of the value, or of a list's entries
  std::optional<Type> count_type;  ///< of a list's count; absent: no list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Encoding encoding{};
  std::vector<Element> elements;
  std::size_t body_offset = 0;  ///< bytes before the first record
  std::size_t line_count = 0;   ///< lines before the first record
};

/// Reads the header of `bytes`. Throws InputError, beginning with `name` and the line, where it does not
/// follow http://paulbourke.net/dataformats/ply: no `ply`, `format` or `end_header`, a version other
/// than 1.0, an unknown word or type, two elements or two properties of one name, a count that is no number,
/// a list counted in floats.
///
/// Throws InputError, too, where the bytes that follow are fewer than the least that the declared counts
/// need. So each count is safe to allocate for: no element holds more records than the file has bytes.
Header read_header(std::string_view bytes, const std::string& name);

}  // namespace laterna::ply
