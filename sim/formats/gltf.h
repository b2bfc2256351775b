// Cameras of glTF 2.0, as JSON (.gltf): where they stand and how wide they see, with a block of ours for the
// rest.
//
//   "cameras": [{"type": "perspective", "perspective": {"yfov", "aspectRatio", "znear"}, "extensions":
//                {"LATERNA_device": {"kind": "camera"|"projector", "size": [W, H], "fx", "fy", "cx", "cy",
//                                    "lens": {"model", "parameters"}}}}],
//   "nodes": [{"name", "camera": 0, "matrix": [16, column by column]}]
//
// There: a camera looks along -z, x right, y up; a node's matrix is parent_from_node. Here x right, y down, z
// forward: device_from_world = diag(1, -1, -1)·inverse(world_from_node). The world's axes stay as they are.
// Metres, as here. yfov = 2·atan(H / (2·fy)), aspectRatio = (W/fx) / (H/fy): the centre is the picture's
// middle, cx = (W-1)/2, cy = (H-1)/2, since glTF holds no principal point; our block, which other readers
// pass over, does. Source: glTF 2.0 specification, 3.10, Cameras.
#pragma once

#include "sim/formats/parts.h"

#include <string>

namespace laterna {

bool is_gltf(const Tree& tree);

/// `camera_size` is for cameras without our block, whose size glTF does not say (and without aspectRatio: its
/// own). Nodes stand by matrix, or by translation and rotation; parents count. Throws InputError, beginning
/// with `file_name` and the key, also for an orthographic camera, a scaled node, and nodes that are their own
/// parents.
Rig parse_gltf(const std::string& text, glm::ivec2 camera_size, const std::string& file_name);

/// Notes what a reader that does not know our block will not see.
std::string gltf_text(const Rig& rig, Notes& notes);

}  // namespace laterna
