// Where to hold a board: places that a calibration can be made from, for a dry run.
#pragma once

#include "sim/scene_spec.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace laterna {

struct BoardPlaceOptions {
  int count = 8;
  double least_tilt_deg = 15, most_tilt_deg = 40;  ///< between the board's normal and the line to the rig
  double most_roll_deg = 20;
  double nearest = 0.8,
         farthest = 1.25;  ///< times the distance from the first camera at which the scene has it
  double least_lit = 0.6;  ///< share of the points that each projector must light
};

/// The scene once for each place of its first mesh with `board`, drawn from `seed`: tilted about a random
/// axis, its middle on the ray of a random pixel of the first camera, kept where that camera sees every
/// point, by at least 2 % of the image inside its edge, every projector lights `least_lit` of them, and all
/// look at the print by more than 20° from its plane. Nothing else is looked at: what stands before the board
/// is not. Throws InputError for a scene without board, camera or projector, and where 10,000 draws give no
/// such place.
std::vector<SceneSpec> board_places(const SceneSpec& spec, const std::filesystem::path& folder,
                                    const BoardPlaceOptions& options, std::uint64_t seed);

}  // namespace laterna
