// The atlas: where methods are right, weak, refuse, crash, or are silently wrong.
#pragma once

#include "apps/lab/atlas/outcome.h"
#include "apps/lab/runner.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace laterna {

struct AtlasOptions {
  std::uint64_t seed = 1;  ///< all seeds of cells are drawn from it and the cell's name
  bool resume = false;
  bool long_run = false;               ///< also grids with `long = true`
  std::vector<std::string> methods{};  ///< only these; empty: those of each grid
  std::string cell{};                  ///< only the cells whose name begins with it; empty: all
  int sample = 0;                      ///< so many cells drawn at random by `seed`; 0: all
};

/// One condition under one method.
struct AtlasCell {
  std::string grid, name, kind, method;
  nlohmann::json values;                             ///< of the condition
  bool hidden = false;                               ///< what no data can reveal: listed apart, not counted
  std::array<int, 5> counts{};                       ///< by Outcome
  std::string letters;                               ///< one outcome per seed (outcome_letters)
  double error_px = NAN, predicted_px = NAN;         ///< medians over the seeds that answered
  std::vector<std::pair<std::string, int>> reasons;  ///< numbers left out, most frequent first, at most 3
  std::string picture{};  ///< of the first seed that fared worst: a PNG in the folder; empty: none
};

struct Atlas {
  std::vector<AtlasCell> cells;  ///< in the order of the specification, method by method
  bool interrupted = false;
  std::size_t done = 0, all = 0;
  std::uint64_t seed = 1;
};

/// Runs the cells of a specification: grids (grid_file.h) of the kinds of cell_kinds.h, with the settings
///
///   seeds = 20                   how many problems a cell is tried on, by the kind's first method (Laterna's
///   own) methods = ["laterna"]        of the kind's peer_seeds = 3               how many by the other
///   methods hidden = false               true: no data can reveal what is wrong here long = false true: only
///   in long runs
///
/// A cell's seeds depend on its name and `seed` alone, so that results do not change with what else the atlas
/// holds. An exception while a problem is solved is a crash of that seed. `folder` holds the journal
/// (runner.h). Throws InputError for a malformed specification, a method that a kind has not, no cell that
/// matches.
Atlas run_atlas(const std::filesystem::path& specification, const std::filesystem::path& folder,
                const AtlasOptions& options, const Progress& progress = {});

/// {"conditions", "seeds", "methods": {NAME: {"right", "weak", "refused", "silent", "crashed"}}, "hidden":
/// {the same}}: counts of solved problems; `conditions` counts cells of Laterna's own method, `seeds` the
/// fewest that one had.
nlohmann::json atlas_summary(const Atlas& atlas);

/// {CELL: letters} of Laterna's own method: what a later run is compared with.
nlohmann::json atlas_letters(const Atlas& atlas);

/// [{"grid", "cell", "kind", "method", "values", "hidden", "right", ..., "letters", "error_px",
/// "predicted_px", "reasons": [[text, count]], "command"}], and "picture" where there is one; `specification`
/// is named in the commands; each runs its cell alone, with the same seeds, in a folder of its own.
nlohmann::json atlas_cells(const Atlas& atlas, const std::string& specification);

/// The summary as a table, and Laterna's silently wrong and crashed cells by name.
std::string atlas_text(const Atlas& atlas);

}  // namespace laterna
