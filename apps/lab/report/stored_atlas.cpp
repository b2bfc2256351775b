#include "apps/lab/report/stored_atlas.h"

#include "apps/lab/atlas/outcome.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace laterna {

using Json = nlohmann::json;

namespace {

Json cell_of(const std::string& name, const std::string& letters) {
  const std::string grid = name.substr(0, name.find(": "));
  Json cell{{"grid", grid},
            {"cell", name},
            {"method", "laterna"},
            {"hidden", grid.ends_with("what no data can reveal")},
            {"letters", letters}};
  for (std::size_t o = 0; o < outcome_words.size(); ++o)
    cell[outcome_words[o]] = std::count(letters.begin(), letters.end(), outcome_letters[o]);
  return cell;
}

// How many seeds ended so, by the summary and by the cells.
void check_count(const Json& reference, const Json& cells, bool hidden, const char* word,
                 const std::string& place) {
  const char* key = hidden ? "hidden" : "methods";
  const Json own = reference.value(key, Json::object()).value("laterna", Json::object());
  const int said = own.value(word, 0);
  int counted = 0;
  for (const Json& cell : cells)
    if (cell.at("hidden") == hidden) counted += cell.at(word).get<int>();
  if (counted != said)
    throw InputError(fmt::format(
        "{}: {} \"{}\" says {}, but its letters count {}; where grids have other names for what no "
        "data can reveal, give the folder with cells.json",
        place, key, word, said, counted));
}

}  // namespace

Json stored_atlas(const Json& reference, const std::string& name, const std::string& place) {
  Json cells = Json::array(), summary = reference;
  for (const auto& [cell, letters] : reference.at("letters").items())
    cells.push_back(cell_of(cell, letters.get<std::string>()));
  for (const bool hidden : {false, true})
    for (const char* word : outcome_words) check_count(reference, cells, hidden, word, place);
  summary.erase("letters");
  return {{"name", name}, {"summary", summary}, {"cells", cells}};
}

}  // namespace laterna
