// The atlas as heat maps, one for each method, as SVG.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace laterna {

/// The worst of a cell of cells.json: "crashed" or "silent" where any seed was, else what most seeds were.
std::string cell_outcome(const nlohmann::json& cell);

/// The methods of cells, in the order in which they come.
std::vector<std::string> methods_of(const nlohmann::json& cells);

/// One square per condition of one method, grid by grid, with the outcome's colour and letter; those that no
/// data can reveal stand under a line of their own. A pointer that rests on a square shows its condition.
std::string atlas_svg(const nlohmann::json& cells, const std::string& method);

}  // namespace laterna
