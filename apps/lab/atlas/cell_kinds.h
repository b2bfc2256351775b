// The kinds of cells that an atlas may have, behind one signature.
#pragma once

#include "apps/lab/atlas/outcome.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace laterna {

/// Solves one cell's problem of one seed by one method and holds the answer against the truth.
using CellTrial = std::function<Graded(const std::string& method, std::uint64_t seed)>;

struct CellKind {
  std::string name;
  std::vector<std::string> methods;  ///< the first is Laterna's own
  /// Throws InputError, beginning with `place`, for values that the kind has not. `folder` is the
  /// specification's.
  std::function<CellTrial(const nlohmann::json& values, const std::string& place,
                          const std::filesystem::path& folder)>
      prepare;
};

/// points: correspondences of a known geometry (point_condition.h).
CellKind point_cells();
/// boards: sightings of a printed board (board_condition.h).
CellKind board_cells();
/// pictures: the whole round trip of a scene (picture_condition.h).
CellKind picture_cells();

/// By name. Throws InputError, beginning with `place`, for another one.
const CellKind& cell_kind(const std::string& name, const std::string& place);

}  // namespace laterna
