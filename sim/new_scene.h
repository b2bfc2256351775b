// A scene to begin with.
#pragma once

#include <string>

namespace laterna {

/// The commented scene file that `laterna new` prints: a wall with relief and a ball before it, a projector
/// with lens shift and a camera some 1.5 m away. It names no other file.
std::string new_scene_text();

}  // namespace laterna
