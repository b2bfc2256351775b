// A right or wrong result as the file of some tool tells it.
#pragma once

#include "apps/lab/score/score_rig.h"
#include "sim/formats/rig_file.h"

#include <filesystem>
#include <string>

namespace laterna::testing {

struct ToldResult {
  ScoreResult result;
  std::string format;  ///< empty: none holds it, and the result is as it was
};

/// Writes the rig into `folder` in the first format that holds it, counted from the `first`-th, and reads it
/// back. Formats of a camera-projector pair are used where the first camera stands in the world's origin
/// alone: from another world, a wrong pose would be another mistake.
ToldResult told_by_a_file(const Rig& rig, std::size_t first, const std::filesystem::path& folder,
                          const RigReadOptions& options);

}  // namespace laterna::testing
