// Specifications of many trials: grids of values, as a person writes them.
//
//   [[grid]]
//   name = "thin relief"
//   kind = "points"               # what a cell of the grid is
//   relief = [1, 0.1, 1e-3, 0]    # every other key: a value, or a list of values that is swept
//   noise_px = [0.1, 1]
//   points = 500
//
// A grid's cells are all combinations, the last key's values next to each other.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace laterna {

/// One [[grid]].
struct Grid {
  std::string name, kind;
  nlohmann::json settings;  ///< the values of the keys that are settings of the grid, not of its cells
  std::vector<std::pair<std::string, std::vector<nlohmann::json>>> axes;  ///< in the order of the file
  std::string place;  ///< "atlas.toml:3: grid \"thin relief\""
};

/// One combination: its values, and a name such as "thin relief: relief=0.1 noise_px=1" of those that are
/// swept.
struct GridCell {
  std::string name;
  nlohmann::json values;
};

/// Reads a file of grids; `settings` names the keys that are not swept. A list of lists sweeps over lists.
/// Throws InputError, beginning with file and line, for text that is no TOML, anything beside [[grid]], a
/// grid without name or kind, two of one name, an empty list, values that are neither numbers, strings,
/// booleans nor lists, more than 100,000 cells.
std::vector<Grid> parse_grids(std::string_view text, const std::string& file_name,
                              const std::vector<std::string>& settings);

std::vector<GridCell> cells_of(const Grid& grid);

}  // namespace laterna
