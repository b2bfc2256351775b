// A described noun (sim/fields.h) from a JSON object, for specifications whose values are swept; and to one,
// for records.
#pragma once

#include "sim/error.h"
#include "sim/fields.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace laterna {

/// The visitor that sets the fields that an object names.
class JsonReader {
 public:
  JsonReader(const nlohmann::json& object, std::string place) : object_(object), place_(std::move(place)) {}

  template <class T>
  void operator()(const Field& field, T& value) {
    known_.emplace_back(field.key);
    const auto found = object_.find(field.key);
    if (found == object_.end()) return;
    if (!read(*found, field, value))
      throw InputError(fmt::format("{}: {} is {}, expected a {}{}", place_, field.key, found->dump(),
                                   type_of(value),
                                   range_text(field).empty() ? "" : ", " + range_text(field)));
  }

  /// Throws InputError for a key that no field bears.
  void expect_all_known() const {
    for (const auto& [key, value] : object_.items())
      if (std::find(known_.begin(), known_.end(), key) == known_.end())
        throw InputError(fmt::format("{}: unknown key \"{}\", did you mean \"{}\"?", place_, key,
                                     nearest_key(key, known_)));
  }

 private:
  static const char* type_of(double) { return "number"; }
  static const char* type_of(int) { return "whole number"; }
  static const char* type_of(bool) { return "true or false"; }
  static const char* type_of(const std::string&) { return "string"; }
  static const char* type_of(const std::vector<std::string>&) { return "list of strings"; }

  static bool read(const nlohmann::json& json, const Field& field, double& value) {
    if (!json.is_number()) return false;
    value = json.get<double>();
    return in_range(field, value);
  }
  static bool read(const nlohmann::json& json, const Field& field, int& value) {
    if (!json.is_number_integer()) return false;
    const auto number = json.get<double>();
    if (!in_range(field, number) || std::abs(number) > 2e9) return false;
    value = int(number);
    return true;
  }
  static bool read(const nlohmann::json& json, const Field&, bool& value) {
    if (!json.is_boolean()) return false;
    value = json.get<bool>();
    return true;
  }
  static bool read(const nlohmann::json& json, const Field&, std::string& value) {
    if (!json.is_string()) return false;
    value = json.get<std::string>();
    return true;
  }
  static bool read(const nlohmann::json& json, const Field&, std::vector<std::string>& value) {
    if (json.is_string()) {  // a list of one
      value = {json.get<std::string>()};
      return true;
    }
    if (!json.is_array() ||
        !std::all_of(json.begin(), json.end(), [](const auto& e) { return e.is_string(); }))
      return false;
    value = json.get<std::vector<std::string>>();
    return true;
  }

  const nlohmann::json& object_;
  std::string place_;
  std::vector<std::string> known_;
};

/// The noun with the fields that the object names, the others at their defaults. `place` begins each message.
/// Throws InputError for an unknown key, a value of a wrong type or out of its field's range.
template <class T>
T noun_from_json(const nlohmann::json& object, const std::string& place) {
  T noun{};
  JsonReader reader(object, place);
  describe(reader, noun);
  reader.expect_all_known();
  return noun;
}

/// The visitor that writes every field, defaults too: enumerations by name, vectors as arrays, tables as
/// objects, what is absent as null.
class JsonWriter {
 public:
  template <class T>
  void operator()(const Field& field, T& value) {
    object[field.key] = json_of(value);
  }
  nlohmann::json object = nlohmann::json::object();

 private:
  template <class T>
  static nlohmann::json json_of(const T& value) {
    if constexpr (Described<T>) {
      JsonWriter writer;
      T copy = value;
      describe(writer, copy);
      return writer.object;
    } else if constexpr (Named<T>) {
      return names_of(value)[std::size_t(value)];
    } else {
      return value;
    }
  }
  template <class T>
  static nlohmann::json json_of(const std::optional<T>& value) {
    return value ? json_of(*value) : nlohmann::json(nullptr);
  }
  template <class T>
  static nlohmann::json json_of(const std::vector<T>& values) {
    nlohmann::json array = nlohmann::json::array();
    for (const T& value : values) array.push_back(json_of(value));
    return array;
  }
  template <glm::length_t n, class T>
  static nlohmann::json json_of(const glm::vec<n, T>& value) {
    nlohmann::json array = nlohmann::json::array();
    for (glm::length_t i = 0; i < n; ++i) array.push_back(value[i]);
    return array;
  }
};

template <Described T>
nlohmann::json noun_json(T noun) {
  JsonWriter writer;
  describe(writer, noun);
  return writer.object;
}

}  // namespace laterna

#include <algorithm>
#include <cmath>
