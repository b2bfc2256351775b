// JSON as Python values.
#pragma once

#include <pybind11/pybind11.h>
#include <nlohmann/json.hpp>

namespace laterna::python {

/// Dictionaries, lists, texts, numbers, None.
inline pybind11::object value_of(const nlohmann::json& json) {
  namespace py = pybind11;
  if (json.is_object()) {
    py::dict dict;
    for (const auto& [key, value] : json.items()) dict[py::str(key)] = value_of(value);
    return dict;
  }
  if (json.is_array()) {
    py::list list;
    for (const auto& value : json) list.append(value_of(value));
    return list;
  }
  if (json.is_string()) return py::str(json.get_ref<const std::string&>());
  if (json.is_boolean()) return py::bool_(json.get<bool>());
  if (json.is_number_unsigned()) return py::int_(json.get<std::uint64_t>());
  if (json.is_number_integer()) return py::int_(json.get<std::int64_t>());
  if (json.is_number()) return py::float_(json.get<double>());
  return py::none();
}

}  // namespace laterna::python
