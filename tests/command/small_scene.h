// A scene that is quick to render, for the tests of the command.
#pragma once

#include <string>

namespace laterna::testing {

inline const std::string small = R"(
[[mesh]]
shape = "relief"
shape_size = [1.6, 1.0, 0.7]
seed = 7
[[projector]]
name = "left"
size = [320, 200]
throw_ratio = 1.2
lens_shift = [0.0, 0.1]
position = [0.35, -0.1, 2.1]
look_at = [0, 0, 0]
up = [0, 1, 0]
[[camera]]
name = "cam"
size = [400, 250]
fov_x_deg = 42
position = [-0.35, 0.15, 2.0]
look_at = [0, 0, 0]
up = [0.1, 1, 0]
)";

}  // namespace laterna::testing
