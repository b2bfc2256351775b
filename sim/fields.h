// How a noun describes its fields: once, for whoever reads, writes, documents or changes them.
//
//   template <class Visitor>
//   void describe(Visitor& visit, Sensor& sensor) {
//     visit(Field{.key = "bit_depth", .sentence = "Bits per sample.", .low = 1, .high = 16},
//     sensor.bit_depth);
//   }
//
// A visitor is anything with `operator()(const Field&, T&)` for each type of value that a noun holds: bool,
// int, std::uint64_t, double, std::string, an enumeration with names_of(), glm vectors, Matrix3x4,
// std::vector<double>, std::vector<std::string>, std::optional of these, a described noun (a table) and a
// std::vector of described nouns (an array of tables). The default of a field is its value in a
// value-initialised noun, and is written nowhere else.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <concepts>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace laterna {

/// Three rows of four numbers, as files write an affine or a rigid map [A | t].
using Matrix3x4 = std::array<std::array<double, 4>, 3>;

/// What is to be said about a field. For vectors and matrices the range holds for each number. Numbers are
/// finite always.
struct Field {
  const char* key;            ///< as files spell it
  const char* unit = "";      ///< "m", "px", "deg"; empty: none
  const char* sentence = "";  ///< for the docs: what it is, and what its absence means
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_excluded = false;  ///< the number must be greater than `low`
};

/// Whether `number` is finite and in the field's range.
bool in_range(const Field& field, double number);

/// The range in words: "0 to 1", "above 0", "at least 0"; empty where any finite number will do.
std::string range_text(const Field& field);

/// The number of single characters to insert, delete or replace to turn `a` into `b` (Levenshtein).
int edit_distance(std::string_view a, std::string_view b);

/// The key nearest to `key` by edit distance, the first of several; empty where there is none.
std::string nearest_key(std::string_view key, std::span<const std::string> known);

/// A visitor that does nothing.
struct NoVisitor {
  template <class T>
  void operator()(const Field&, T&) const {}
};

/// A noun with a description.
template <class T>
concept Described = requires(NoVisitor& visit, T& noun) { describe(visit, noun); };

/// An enumeration with names_of(T{}): the names of its values 0, 1, 2, ... in this order.
template <class T>
concept Named = std::is_enum_v<T> && requires(T value) {
  { names_of(value) } -> std::convertible_to<std::span<const char* const>>;
};

/// Whether T is a std::vector of described nouns: an array of tables.
template <class T>
inline constexpr bool is_array_of_tables = false;
template <Described T>
inline constexpr bool is_array_of_tables<std::vector<T>> = true;

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

/// The keys of a noun, in the order of its description.
template <Described T>
std::vector<std::string> keys_of(T noun = {}) {
  std::vector<std::string> keys;
  auto visit = [&](const Field& field, auto&) { keys.emplace_back(field.key); };
  describe(visit, noun);
  return keys;
}

}  // namespace laterna
