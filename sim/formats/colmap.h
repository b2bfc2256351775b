// COLMAP's text models: a folder with cameras.txt and images.txt.
//
//   cameras.txt  CAMERA_ID MODEL WIDTH HEIGHT PARAMS...
//   images.txt   IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then a line of points (passed over, may be
//   empty)
//
// There: the upper left pixel's centre is at (0.5, 0.5); here at (0, 0): cx_here = cx_there - 0.5, and cy
// likewise. Poses are device_from_world, as here, by quaternion w, x, y, z; x right, y down, z forward, as
// here. Lengths are in no stated unit. Models: SIMPLE_PINHOLE (f, cx, cy), PINHOLE (fx, fy, cx, cy),
// SIMPLE_RADIAL (f, cx, cy, k), RADIAL (f, cx, cy, k1, k2), OPENCV (fx, fy, cx, cy, k1, k2, p1, p2),
// FULL_OPENCV (the same, k3 to k6). A device is an image; its name is the image's without its ending, with _
// for /. COLMAP knows no projectors: an image whose name begins with "proj" is one.
// https://colmap.github.io/format.html, https://colmap.github.io/cameras.html
#pragma once

#include "sim/formats/parts.h"

#include <string>

namespace laterna {

/// Throws InputError, beginning with the file and line, for anything but such texts.
Rig parse_colmap(const std::string& cameras_txt, const std::string& images_txt, const std::string& folder);

struct ColmapText {
  std::string cameras_txt, images_txt;
};

/// PINHOLE, OPENCV or FULL_OPENCV, whichever holds the lens (k4 to k6 that it lacks are 0). Throws InputError
/// for a lens that is none of OpenCV's or has thin-prism terms.
ColmapText colmap_text(const Rig& rig, Notes& notes);

}  // namespace laterna
