// The .cameramodel files of mrcal: a lens, its place in the world and its picture's size, as text.
#pragma once

#include "sim/device.h"

#include <filesystem>
#include <string>

namespace laterna {

/// Reads intrinsics, lens and device_from_world (mrcal: rt_cam_ref, a Rodrigues vector and a translation that
/// take coordinates of mrcal's reference frame, here the world, to the camera's). The name is the file's,
/// without its ending. mrcal's `valid_intrinsics_region`, `icam_intrinsics` and `optimization_inputs` are
/// passed over. Throws InputError, beginning with the path, for a file that cannot be read, is larger than 64
/// MiB or no text, that mrcal's parser refuses, or whose device validate() refuses.
Device read_cameramodel(const std::filesystem::path& path);

/// The same from text; `file_name` begins each message.
Device parse_cameramodel(const std::string& text, const std::string& file_name);

/// The text of a .cameramodel file, with every number to its last bit (mrcal's own C function writes six
/// decimals). Reading it back gives the same intrinsics and lens exactly, and the placement to rounding.
/// Light planes and name are not part of the format.
std::string cameramodel_text(const Device& device);

}  // namespace laterna
