// The random values of one sample, and the scene that they make.
#pragma once

#include "apps/lab/dataset/dataset_spec.h"
#include "sim/scene_spec.h"

#include <cstdint>
#include <string>
#include <vector>

namespace laterna {

/// What was drawn: scene path and value, in the order of the specification; a chosen table as its keys.
struct DrawnValues {
  std::vector<std::pair<std::string, nlohmann::json>> values;
  std::vector<int> absent;  ///< meshes that are not there, rising
  bool operator==(const DrawnValues&) const = default;
};

/// Depends on its arguments alone.
DrawnValues draw_values(const DatasetSpec& spec, std::uint64_t seed, std::uint64_t sample,
                        std::uint64_t attempt);

/// The scene's specification with these values; it may be left without a mesh. Throws InputError as
/// parse_scene() does, and where a mesh is not there to be absent.
SceneSpec scene_of(const DatasetSpec& spec, const DrawnValues& drawn);

/// Throws InputError, beginning with the key's place, where no sound scene is built from an end of one of the
/// distributions, the other values being those of the first sample and all meshes there: all files of all
/// choices are read. Also where `present` or `format` does not suit the scene.
void check_ends(const DatasetSpec& spec, std::uint64_t seed);

}  // namespace laterna
