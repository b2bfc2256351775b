// BOP's scene_camera.json: cameras of a benchmark for 6-D poses of objects.
//
//   {"0": {"cam_K": [fx, 0, cx, 0, fy, cy, 0, 0, 1], "cam_R_w2c": [9], "cam_t_w2c": [3], "depth_scale": 0.1},
//   ...}
//
// There: K and R row by row, x_camera = cam_R_w2c·x_world + cam_t_w2c, in millimetres; here metres. Pixel
// centres at whole numbers, x right, y down, z forward: alike. No lens and, in the format itself, neither
// sizes nor names nor projectors: "width", "height" and "name" are ours beside each K, which BOP's own
// readers pass over; without them device "7" is a camera of that name.
// https://github.com/thodan/bop_toolkit/blob/master/docs/bop_datasets_format.md
#pragma once

#include "sim/formats/parts.h"

#include <string>

namespace laterna {

bool is_bop(const Tree& tree);

/// One camera of the file; `key` is its name where it has none.
Device bop_device(const Place& entry, const std::string& key);

/// A camera without R and t stands at the world's origin. Throws InputError, beginning with `file_name` and
/// the key.
Rig parse_bop(const std::string& text, const std::string& file_name);

/// Throws InputError for a device with a lens.
std::string bop_text(const Rig& rig, Notes& notes);

}  // namespace laterna
