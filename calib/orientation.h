// Which way round a camera sees the projector's picture.
#pragma once

#include "calib/decoded_map.h"

#include <string>

namespace laterna {

/// Camera and projector look at the same side of a surface, so the map from camera to projector pixels keeps
/// its handedness, however both are turned: a negative Jacobian means a mirrored picture (rear projection, a
/// mirror in the path, pictures shown or stored flipped).
struct Orientation {
  bool known = false;     ///< enough pixels, and at least 9 in 10 agree on the handedness
  bool mirrored = false;  ///< of the majority
  int quarter_turns = 0;  ///< 0 to 3, clockwise as the camera sees the picture; of a mirrored one after
                          ///< flipping its columns
  double agreement = 0;   ///< share of the pixels that have the majority's handedness
};

/// From differences of u and v over 8 camera pixels.
Orientation orientation_of(const DecodedMap& map);

/// For people: "upright", "turned by 90° clockwise", "mirrored: columns run backwards", ...
std::string orientation_words(const Orientation& orientation);

}  // namespace laterna
