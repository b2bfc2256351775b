#include "apps/lab/grid_file.h"

#include "apps/lab/toml_text.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace laterna {

namespace {

using Json = nlohmann::json;

constexpr std::size_t most_cells = 100000;

[[noreturn]] void fail(const std::string& file, const toml::node& node, const std::string& sentence) {
  throw InputError(fmt::format("{}:{}: {}", file, node.source().begin.line, sentence));
}

Json value_of(const toml::node& node, const std::string& file) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* integer = node.as_integer()) return integer->get();
  if (const auto* number = node.as_floating_point()) return number->get();
  if (const auto* boolean = node.as_boolean()) return boolean->get();
  if (const auto* array = node.as_array()) {
    Json list = Json::array();
    for (const toml::node& element : *array) list.push_back(value_of(element, file));
    return list;
  }
  fail(file, node, "found a table or a date, expected a number, a string, true or false, or a list");
}

// Keys in the order in which they stand: the parser sorts them.
std::vector<std::pair<std::string, const toml::node*>> in_order(const toml::table& table) {
  std::vector<std::pair<std::string, const toml::node*>> keys;
  for (const auto& [key, node] : table) keys.emplace_back(std::string(key.str()), &node);
  std::stable_sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) {
    const auto &x = a.second->source().begin, &y = b.second->source().begin;
    return x.line != y.line ? x.line < y.line : x.column < y.column;
  });
  return keys;
}

std::string text_under(const toml::table& table, const char* key, const std::string& file) {
  const toml::node* node = table.get(key);
  if (!node || !node->is_string() || node->as_string()->get().empty())
    fail(file, table, fmt::format("[[grid]] has no {}, expected a string", key));
  return node->as_string()->get();
}

Grid grid_of(const toml::table& table, const std::string& file, const std::vector<std::string>& settings) {
  Grid grid{text_under(table, "name", file), text_under(table, "kind", file), Json::object(), {}, {}};
  grid.place = fmt::format("{}:{}: grid \"{}\"", file, table.source().begin.line, grid.name);
  std::size_t cells = 1;
  for (const auto& [key, node] : in_order(table)) {
    if (key == "name" || key == "kind") continue;
    const Json value = value_of(*node, file);
    if (std::find(settings.begin(), settings.end(), key) != settings.end()) {
      grid.settings[key] = value;
      continue;
    }
    if (value.is_array() && value.empty()) fail(file, *node, fmt::format("{} is an empty list", key));
    grid.axes.emplace_back(key, value.is_array() ? value.get<std::vector<Json>>() : std::vector<Json>{value});
    cells *= grid.axes.back().second.size();
    if (cells > most_cells) fail(file, table, fmt::format("more than {} cells in one grid", most_cells));
  }
  return grid;
}

}  // namespace

std::vector<Grid> parse_grids(std::string_view text, const std::string& file,
                              const std::vector<std::string>& settings) {
  const toml::table table = parse_toml(text, file);
  for (const auto& [key, node] : table)
    if (key.str() != "grid" || !node.is_array_of_tables())
      fail(file, node, fmt::format("found \"{}\", expected [[grid]] alone", std::string(key.str())));
  std::vector<Grid> grids;
  std::set<std::string> names;
  if (const toml::node* list = table.get("grid")) {
    for (const toml::node& node : *list->as_array()) {
      grids.push_back(grid_of(*node.as_table(), file, settings));
      if (!names.insert(grids.back().name).second)
        throw InputError(grids.back().place + ": the name is taken");
    }
  }
  if (grids.empty()) throw InputError(file + ": no [[grid]], expected at least one");
  return grids;
}

std::vector<GridCell> cells_of(const Grid& grid) {
  std::vector<GridCell> cells{{grid.name, Json::object()}};
  bool first = true;
  for (const auto& [key, values] : grid.axes) {
    std::vector<GridCell> longer;
    for (const GridCell& cell : cells) {
      for (const Json& value : values) {
        longer.push_back(cell);
        longer.back().values[key] = value;
        if (values.size() > 1)
          longer.back().name += fmt::format("{} {}={}", first ? ":" : "", key, value.dump());
      }
    }
    first = first && values.size() == 1;
    cells = std::move(longer);
  }
  return cells;
}

}  // namespace laterna
