#include "sim/pattern_json.h"

#include "sim/error.h"
#include "sim/field_text.h"
#include "sim/scene_fields.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <concepts>

namespace laterna {

namespace {

using Json = nlohmann::json;

template <class T>
Json json_of(const T& value) {
  if constexpr (Named<T>)
    return names_of(value)[std::size_t(value)];
  else
    return value;
}

/// Each read() tells whether the JSON holds a value of its type and in its range.
template <Named T>
bool read(const Json& json, const Field&, T& value) {
  const auto names = names_of(value);
  const auto name = std::find(names.begin(), names.end(), json.is_string() ? json.get<std::string>() : "");
  if (name == names.end()) return false;
  value = T(name - names.begin());
  return true;
}
bool read(const Json& json, const Field&, bool& value) {
  if (!json.is_boolean()) return false;
  value = json.get<bool>();
  return true;
}
bool read(const Json& json, const Field& field, double& value) {
  if (!json.is_number()) return false;
  value = json.get<double>();
  return in_range(field, value);
}
bool read(const Json& json, const Field& field, int& value) {
  double number = 0;
  if (!json.is_number_integer() || !read(json, field, number)) return false;
  value = int(number);
  return true;
}
bool read(const Json& json, const Field& field, std::vector<double>& values) {
  if (!json.is_array()) return false;
  values.assign(json.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!read(json[i], field, values[i])) return false;
  return true;
}

}  // namespace

Json patterns_json(const PatternParameters& patterns) {
  Json all, defaults;
  const auto write = [](Json& json, PatternParameters parameters) {
    auto visit = [&](const Field& field, auto& value) { json[field.key] = json_of(value); };
    describe(visit, parameters);
  };
  write(all, patterns);
  write(defaults, {});
  if (all == defaults) return all["kind"];
  for (const auto& [key, value] : defaults.items())
    if (key != "kind" && all[key] == value) all.erase(key);
  return all;
}

PatternParameters patterns_of(const Json& json) {
  const Json object = json.is_object() ? json : Json{{"kind", json}};
  PatternParameters patterns;
  const std::vector<std::string> known = keys_of<PatternParameters>();
  for (const auto& [key, value] : object.items()) {
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw InputError(fmt::format("patterns: unknown key {}, did you mean \"{}\"?", toml_text(key),
                                   nearest_key(key, known)));
  }
  auto visit = [&]<class T>(const Field& field, T& value) {
    if (object.contains(field.key) && !read(object[field.key], field, value))
      throw InputError(fmt::format("patterns: {} is {}, expected {}", field.key, object[field.key].dump(),
                                   expected_text<T>(field)));
  };
  describe(visit, patterns);
  return patterns;
}

}  // namespace laterna
