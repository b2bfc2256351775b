// The kinds of cells that an atlas may have, behind one signature.
#pragma once

#include "apps/lab/atlas/outcome.h"
#include "apps/lab/files_digest.h"
#include "apps/lab/simulation.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace laterna {

/// What a method makes of one problem, and how far it is from the truth. Errors are NaN where refused.
struct CellAnswer {
  Status status = Status::refused;
  std::string reason;                    ///< the method's own
  double error_px = NAN;                 ///< of the volume, rms, projector pixels
  double error_mm = NAN;                 ///< pictures: of the light on the lit surface, rms, across the ray
  std::optional<double> predicted_px;    ///< of error_px, by the method itself; none: it makes no prediction
  std::optional<double> independent_px;  ///< pictures: SolveResult::predicted_volume_rms_independent_px
  int pictures = 0;                      ///< that its projectors showed
  StageTimes times{};                    ///< without what only holds the answer against the truth
};

/// One problem of a cell. Solving it again gives the same answer in other times.
struct CellProblem {
  std::function<CellAnswer(const std::string& method)> solve;
  std::function<double()> bound_px;  ///< what noise alone does to error_px (Cramér-Rao); NaN: not known
  /// To look at: what the first camera saw in white light, and beside it the columns that were decoded, in
  /// viridis; only pictures have one.
  std::function<Image<glm::u8vec3>()> picture{};
};

/// The answer under the five outcomes; where the method makes no prediction, the bound is held against it.
Graded graded(const CellAnswer& answer, const CellProblem& problem);

/// One cell's problem of one seed.
using CellTrial = std::function<CellProblem(std::uint64_t seed)>;

struct CellKind {
  std::string name;
  std::vector<std::string> methods;  ///< the first is Laterna's own
  /// Throws InputError, beginning with `place`, for values that the kind has not. `folder` is the
  /// specification's.
  std::function<CellTrial(const nlohmann::json& values, const std::string& place,
                          const std::filesystem::path& folder)>
      prepare;
  /// The files that a cell reads beside the specification; none: it reads none. Throws as `prepare` does.
  std::function<std::vector<std::filesystem::path>(const nlohmann::json& values, const std::string& place,
                                                   const std::filesystem::path& folder)>
      files{};
};

/// points: correspondences of a known geometry (point_condition.h).
CellKind point_cells();
/// boards: sightings of a printed board (board_condition.h).
CellKind board_cells();
/// pictures: the whole round trip of a scene (picture_condition.h).
CellKind picture_cells();

/// By name. Throws InputError, beginning with `place`, for another one.
const CellKind& cell_kind(const std::string& name, const std::string& place);

/// One cell of a specification, as far as it tells the files that the cell reads.
struct CellValues {
  std::string kind;
  nlohmann::json values;
  std::string place;  ///< for messages
};

/// file_digests() of the specification and all the files that its cells read. Throws as `prepare` does.
std::vector<FileDigest> digests_of(const std::vector<CellValues>& cells,
                                   const std::filesystem::path& specification);

}  // namespace laterna
