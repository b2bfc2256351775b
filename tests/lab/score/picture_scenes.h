// Scenes drawn at random whose pictures are small: what mistakes of pictures are planted in.
#pragma once

#include <random>
#include <string>

namespace laterna::testing {

/// A scene file: a relief of 1.6 by 1 m, 0.4 to 0.8 m deep, before a projector ("projector") of 128 to 192
/// pixels and a camera ("camera") of some 200 by 130, both anywhere before it within 25 degrees or so, turned
/// a little; lens shift of up to half a picture, half of the rigs with a lens; half of
/// the cameras with four samples a pixel; noise of an EMVA 1288 sensor, or of 0.3 to 1.5 DN. `family` chooses
/// the patterns, of all coded families in turn.
std::string picture_scene(int family, std::mt19937_64& random);

}  // namespace laterna::testing
