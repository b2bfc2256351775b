// Cameras of OpenUSD, as text (.usda).
//
//   def Camera "left" {
//     float focalLength, horizontalAperture, verticalAperture, horizontalApertureOffset,
//     verticalApertureOffset matrix4d xformOp:transform = ((...), (...), (...), (...))      uniform token[]
//     xformOpOrder custom int2 laterna:size   custom string laterna:kind   custom string laterna:lensModel
//     custom double[] laterna:lensParameters
//   }
//
// There: a camera looks along -z, x right, y up; matrices act on row vectors, so that the translation is the
// last row (usd_transform.h has the other operations); lengths are in units of the stage's metersPerUnit
// (0.01 where it says none), lens lengths in a tenth of it (only their ratios count here). The window seen is
// [offset - aperture/2, offset + aperture/2]/focalLength, y up. Here:
//   fx = focalLength/horizontalAperture·W      cx = (W-1)/2 - horizontalApertureOffset/horizontalAperture·W
//   fy = focalLength/verticalAperture·H        cy = (H-1)/2 + verticalApertureOffset/verticalAperture·H
//   device_from_world = diag(1, -1, -1)·inverse(world_from_camera)
// The world's axes stay as they are (upAxis is passed over). A picture's size, lens and whether it is a
// projector are in attributes of ours (`laterna:`), which other readers pass over; without them the size is
// given from outside, and a name that begins with "proj" tells projectors.
// https://openusd.org/release/api/class_usd_geom_camera.html
#pragma once

#include "sim/formats/parts.h"

#include <string>

namespace laterna {

/// Reads `def Camera` and what stands above them (usd_transform.h). Throws InputError, beginning with
/// `file_name` and the line or the prim, also for transforms that are not rigid, time samples and for a
/// camera without a size of its own where `camera_size` is 0.
Rig parse_usd_cameras(const std::string& text, glm::ivec2 camera_size, const std::string& file_name);

/// A stage in metres. Names become prims' names: what is no letter, digit or _ is an InputError.
std::string usd_camera_text(const Rig& rig, Notes& notes);

}  // namespace laterna
