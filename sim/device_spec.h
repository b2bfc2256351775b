// From what a file says of a device to the device.
#pragma once

#include "sim/scene_spec.h"

#include <filesystem>
#include <string>

namespace laterna {

/// Throws InputError, beginning with `what`, unless intrinsics and placement are given in exactly one way
/// each, with all that this way needs:
///   intrinsics: fx, fy, cx, cy | throw_ratio, lens_shift | fov_y_deg, aspect | fov_x_deg, aspect |
///   cameramodel; placement:  device_from_world | position, look_at, up | rotation_vector_rad, translation |
///               quaternion_wxyz, translation | cameramodel.
void check_ways(const DeviceSpec& spec, const std::string& what);

/// The device, validated; a cameramodel file is looked for in `folder`. The name is spec.name. Throws
/// InputError, beginning with `what`.
Device device_of(const DeviceSpec& spec, const std::filesystem::path& folder, const std::string& what);

}  // namespace laterna
