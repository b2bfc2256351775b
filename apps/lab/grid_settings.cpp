#include "apps/lab/grid_settings.h"

#include "sim/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace laterna {

namespace {

using Json = nlohmann::json;

[[noreturn]] void fail(const Grid& grid, const char* key, const char* expected) {
  throw InputError(
      fmt::format("{}: {} is {}, expected {}", grid.place, key, grid.settings[key].dump(), expected));
}

}  // namespace

int count_setting(const Grid& grid, const char* key, int otherwise) {
  if (!grid.settings.contains(key)) return otherwise;
  const Json& given = grid.settings[key];
  if (!given.is_number_integer() || given.get<long>() < 1 || given.get<long>() > 1000000)
    fail(grid, key, "a whole number from 1");
  return given.get<int>();
}

double positive_setting(const Grid& grid, const char* key, double otherwise) {
  if (!grid.settings.contains(key)) return otherwise;
  const Json& given = grid.settings[key];
  if (!given.is_number() || !(given.get<double>() > 0 && given.get<double>() < 1e9))
    fail(grid, key, "a number above 0");
  return given.get<double>();
}

bool flag_setting(const Grid& grid, const char* key) {
  if (!grid.settings.contains(key)) return false;
  if (!grid.settings[key].is_boolean()) fail(grid, key, "true or false");
  return grid.settings[key].get<bool>();
}

std::string word_setting(const Grid& grid, const char* key, const std::string& otherwise) {
  if (!grid.settings.contains(key)) return otherwise;
  if (!grid.settings[key].is_string()) fail(grid, key, "a string");
  return grid.settings[key].get<std::string>();
}

std::vector<std::string> methods_setting(const Grid& grid, const std::vector<std::string>& known) {
  if (!grid.settings.contains("methods")) return {"laterna"};
  const Json& given = grid.settings["methods"];
  std::vector<std::string> methods;
  for (const Json& name : given.is_array() ? given : Json::array({given}))
    methods.push_back(name.is_string() ? name.get<std::string>() : name.dump());
  for (const std::string& method : methods)
    if (std::find(known.begin(), known.end(), method) == known.end())
      throw InputError(fmt::format("{}: no method \"{}\" for {}, expected some of {}", grid.place, method,
                                   grid.kind, fmt::join(known, ", ")));
  return methods;
}

}  // namespace laterna
