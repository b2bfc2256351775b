// Numbers that may not be finite, in JSON.
#pragma once

#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>

namespace laterna {

/// null where the number is not finite.
inline nlohmann::json finite_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

/// null where there is none either.
inline nlohmann::json finite_or_null(const std::optional<double>& value) {
  return value ? finite_or_null(*value) : nlohmann::json(nullptr);
}

/// NaN where the object holds null under the key, or nothing.
inline double number_or_nan(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : double(NAN);
}

}  // namespace laterna
