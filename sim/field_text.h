// The values of described fields as TOML text, and their types in words.
#pragma once

#include "sim/fields.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace laterna {

/// The shortest decimal that reads back to the same bits, always with a point or an exponent.
std::string toml_text(double value);
/// A basic string, quoted and escaped.
std::string toml_text(const std::string& value);
inline std::string toml_text(bool value) { return value ? "true" : "false"; }
inline std::string toml_text(int value) { return std::to_string(value); }
inline std::string toml_text(std::uint64_t value) { return std::to_string(value); }

inline std::string toml_text(const std::array<double, 4>& value);

/// "[a, b, c]".
template <class T>
std::string toml_list(const T* values, std::size_t count) {
  std::string text = "[";
  for (std::size_t i = 0; i < count; ++i) text += (i ? ", " : "") + toml_text(values[i]);
  return text + "]";
}
template <glm::length_t n, class T>
std::string toml_text(const glm::vec<n, T>& value) {
  return toml_list(&value[0], n);
}
inline std::string toml_text(const std::vector<double>& value) {
  return toml_list(value.data(), value.size());
}
inline std::string toml_text(const std::vector<std::string>& value) {
  return toml_list(value.data(), value.size());
}
inline std::string toml_text(const std::array<double, 4>& value) {
  return toml_list(value.data(), value.size());
}
inline std::string toml_text(const Matrix3x4& value) { return toml_list(value.data(), value.size()); }
template <Named T>
std::string toml_text(T value) {
  return toml_text(std::string(names_of(value)[std::size_t(value)]));
}
/// Empty where the value is absent.
template <class T>
std::string toml_text(const std::optional<T>& value) {
  return value ? toml_text(*value) : std::string();
}

/// A key and the text of its value.
struct FieldText {
  std::string key, value;
};

/// The fields that hold a value, described nouns as inline tables; arrays of tables are passed over.
template <Described T>
std::vector<FieldText> field_texts(T noun);

/// Those of field_texts() that differ from the default.
template <Described T>
std::vector<FieldText> changed_field_texts(const T& noun) {
  const std::vector<FieldText> all = field_texts(noun), unchanged = field_texts(T{});
  std::vector<FieldText> changed;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].value != unchanged[i].value && !all[i].value.empty()) changed.push_back(all[i]);
  return changed;
}

/// An inline table of what differs from the default; empty where nothing does.
template <Described T>
std::string toml_text(const T& noun) {
  std::string text;
  for (const FieldText& field : changed_field_texts(noun))
    text += (text.empty() ? "{ " : ", ") + field.key + " = " + field.value;
  return text.empty() ? text : text + " }";
}

template <Described T>
std::vector<FieldText> field_texts(T noun) {
  std::vector<FieldText> texts;
  auto visit = [&]<class V>(const Field& field, V& value) {
    if constexpr (!is_array_of_tables<V>) texts.push_back({field.key, toml_text(value)});
  };
  describe(visit, noun);
  return texts;
}

/// What a value must be, in words: "a number above 0", "2 integers from 1 to 16384", "one of "y", "z"".
template <class T>
std::string expected_text(const Field& field) {
  const std::string range = range_text(field), bounded = range.empty() ? "" : " (" + range + ")";
  if constexpr (is_optional<T>) return expected_text<typename T::value_type>(field);
  if constexpr (std::is_same_v<T, bool>) return "true or false";
  if constexpr (std::is_same_v<T, int> || std::is_same_v<T, std::uint64_t>) return "an integer" + bounded;
  if constexpr (std::is_same_v<T, double>) return "a number" + bounded;
  if constexpr (std::is_same_v<T, std::string>) return "a string";
  if constexpr (std::is_same_v<T, std::vector<double>>) return "an array of numbers" + bounded;
  if constexpr (std::is_same_v<T, std::vector<std::string>>) return "an array of strings";
  if constexpr (std::is_same_v<T, Matrix3x4>) return "3 rows of 4 numbers" + bounded;
  if constexpr (std::is_same_v<T, glm::ivec2>) return "2 integers" + bounded;
  if constexpr (std::is_same_v<T, glm::dvec2>) return "2 numbers" + bounded;
  if constexpr (std::is_same_v<T, glm::dvec3>) return "3 numbers" + bounded;
  if constexpr (std::is_same_v<T, glm::dvec4>) return "4 numbers" + bounded;
  if constexpr (Named<T>) {
    std::string names;
    for (const char* name : names_of(T{}))
      names += (names.empty() ? "" : ", ") + toml_text(std::string(name));
    return names_of(T{}).size() == 1 ? names : "one of " + names;
  }
  if constexpr (Described<T>) return "a table";
  return "an array of tables";
}

}  // namespace laterna
