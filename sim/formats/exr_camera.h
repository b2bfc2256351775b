// A camera in the header of an OpenEXR picture: the standard attributes worldToCamera and worldToNDC.
//
//   worldToCamera   m44f   camera_from_world; there the camera is left-handed: x right, y up, z forward
//   worldToNDC      m44f   window_from_world: after the divide (0, 0) is the upper left and (1, 1) the lower
//                          right corner of the display window, x right, y down; its third column is passed
//                          over
//   cameraLabel     string the camera's name; where it is missing, the file's without its ending
//
// There: a point is a row before the matrix, (x', y', z', w') = (x, y, z, 1)·M, so that worldToCamera's last
// row is the translation; single precision. Corners are the outer edges of the outermost pixels, as in
// RenderMan, whose spaces OpenEXR names as its own. Here: x right, y down, z forward, and pixel centres at
// whole numbers, half a pixel inside that edge:
//   worldToCamera = (diag(1, -1, 1, 1)·device_from_world)ᵀ
//   u = x'/w'·W - 0.5      v = y'/w'·H - 0.5      in texture coordinates: x'/w' = s/q, y'/w' = 1 - t/q
// What is written has w' = q, the depth in metres, and z'/w' = r/q. Lengths are in no stated unit. The file
// holds no lens: a picture through one gets worldToCamera alone, and is no camera when read back.
// https://openexr.com/en/latest/StandardAttributes.html, ImfStandardAttributes.h of OpenEXR 3.1 (the frames)
#pragma once

#include "sim/device.h"
#include "sim/image_file.h"

#include <filesystem>
#include <string>

namespace laterna {

/// What a picture by this device says of it: without window_from_world where it has a lens.
PictureCamera picture_camera(const Device& device);

/// The pinhole of both matrices, in a picture of `window` pixels: placement from the first, fx, fy, cx, cy
/// from the second. Throws InputError, beginning with `place`, where one is missing or not finite, the first
/// is not a left-handed rigid motion, or the second is no such pinhole at that place within 1e-5 (skewed,
/// parallel, y up, seen from elsewhere).
Device device_of(const PictureCamera& camera, glm::ivec2 window, const std::string& place);

/// The device of an EXR picture, whose display window is its size.
Device read_exr_camera(const std::filesystem::path& path);

/// An EXR file of one black pixel whose display window is the device's picture. Throws InputError for a lens.
std::string exr_camera_bytes(const Device& device);

}  // namespace laterna
